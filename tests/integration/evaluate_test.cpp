// `constrictor evaluate` with toy components: real runs, several at a time, that are interrupted, continued, divided
// and gathered.
#include <sysexits.h>

#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class Evaluate : public RunCommand {
 protected:
  /// Starts an evaluation of runs of `ticks` ticks in the folder `output`.
  [[nodiscard]] Process evaluate(long ticks, const std::string& output, std::vector<std::string> more) const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    if (!fs::exists(dir_ / scenario)) write(scenario, "");
    std::vector<std::string> arguments = {"evaluate",   (dir_ / scenario).string(),
                                          "--manifest", (dir_ / "toys.yaml").string(),
                                          "--output",   (dir_ / output).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return command(arguments);
  }
  [[nodiscard]] std::string text(const fs::path& file) const {
    std::ifstream stream(dir_ / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  [[nodiscard]] nlohmann::json summary(const std::string& output) const {
    return nlohmann::json::parse(text(fs::path(output) / "summary.json"), nullptr, false);
  }
  /// The first run of seed 1 carries out these commands of the shell before it begins.
  void in_first_run(const std::string& commands) const {
    write("script", "#!/bin/sh\nif [ \"$(echo \"$@\" | grep -c -e '--seed 1 ')\" = 1 ] && mkdir " +
                        (dir_ / "first").string() + "; then " + commands + "; fi\nexec " + program("toy_host") +
                        " \"$@\"\n");
    fs::permissions(dir_ / "script", fs::perms::owner_all);
    std::string manifest = kManifest;
    for (auto at = manifest.find("toy_host"); at != std::string::npos; at = manifest.find("toy_host", at))
      manifest.replace(at, 8, (dir_ / "script").string());
    write("toys.yaml", manifest);
  }
  /// The state hash of each run that is over, by the run's folder.
  [[nodiscard]] std::map<std::string, std::string> hashes(const std::string& output) const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(dir_ / output / "runs")) {
      if (entry.path().filename() != "outcome.json") continue;
      const fs::path run = entry.path().parent_path();
      const auto report = nlohmann::json::parse(text(run / "report.json"), nullptr, false);
      found[fs::relative(run, dir_ / output)] = report.value("state_hash", "none");
    }
    return found;
  }
};

TEST_F(Evaluate, DoesEveryRunAsRunDoesItAndContinuesWithOtherSeeds) {
  Process first = evaluate(60, "e", {"--seeds", "1..3", "--jobs", "2"});
  ASSERT_EQ(first.wait(60s), exit_status::kOk) << first.output() << first.errors();
  const auto done = hashes("e");
  ASSERT_EQ(done.size(), 3u);
  Process alone = run(60, "alone", {"--in-process", "--seed", "2"});
  ASSERT_EQ(alone.wait(30s), exit_status::kOk) << alone.errors();
  EXPECT_EQ(done.at("runs/as_given/seed_0002"), state_hash("alone"));
  EXPECT_EQ(summary("e").at("variants").at(0).at("runs"), 3);
  EXPECT_NE(text("e/index.html").find("--seed 3"), std::string::npos) << "the command that repeats the run";

  const auto before = fs::last_write_time(dir_ / "e/runs/as_given/seed_0001/outcome.json");
  Process second = evaluate(60, "e", {"--seeds", "1..4"});
  ASSERT_EQ(second.wait(60s), exit_status::kOk) << second.errors();
  EXPECT_NE(second.output().find("3 runs done before, 1 left"), std::string::npos) << second.output();
  EXPECT_EQ(fs::last_write_time(dir_ / "e/runs/as_given/seed_0001/outcome.json"), before);
  EXPECT_EQ(hashes("e").size(), 4u);
  expect_nobody_left();
}

TEST_F(Evaluate, CtrlCLeavesWhatIsDoneAndTheSameCommandDoesTheRest) {
  Process evaluation = evaluate(400, "e", {"--seeds", "1..30", "--jobs", "2"});
  ASSERT_TRUE(evaluation.wait_for("seed 1", 60s)) << evaluation.output() << evaluation.errors();
  evaluation.signal(SIGINT);
  ASSERT_EQ(evaluation.wait(30s), 130) << evaluation.errors();
  EXPECT_NE(evaluation.output().find("interrupted"), std::string::npos);
  const auto done = hashes("e");
  EXPECT_GE(done.size(), 1u);
  EXPECT_LT(done.size(), 30u);
  EXPECT_EQ(summary("e").at("variants").at(0).at("runs"), done.size());
  expect_nobody_left();

  const std::string last = std::to_string(done.size() + 2);
  Process rest = evaluate(400, "e", {"--seeds", "1.." + last, "--jobs", "2"});
  ASSERT_EQ(rest.wait(60s), exit_status::kOk) << rest.output() << rest.errors();
  for (const auto& [folder, hash] : done) EXPECT_EQ(hashes("e").at(folder), hash);
}

TEST_F(Evaluate, PartsOfSeveralMachinesGiveTheSameResultsAsOneWhole) {
  const std::vector<std::string> both{"--vary", "noise.camera_sd=0,0.5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), both.begin(), both.end());
    return more;
  };
  for (const auto& [output, options] :
       {std::pair{"whole", with({"--seeds", "1..3"})}, std::pair{"one", with({"--seeds", "1..3", "--shard", "1/2"})},
        std::pair{"two", with({"--seeds", "1..3", "--shard", "2/2"})}}) {
    Process process = evaluate(40, output, options);
    ASSERT_EQ(process.wait(60s), exit_status::kOk) << output << process.errors();
  }
  EXPECT_EQ(hashes("whole").size(), 6u);
  EXPECT_EQ(hashes("one").size() + hashes("two").size(), 6u);
  Process merge = evaluate(40, "all", with({"--merge", (dir_ / "one").string(), (dir_ / "two").string()}));
  ASSERT_EQ(merge.wait(60s), exit_status::kOk) << merge.errors();
  EXPECT_EQ(hashes("all"), hashes("whole"));
  EXPECT_EQ(summary("all").at("variants").size(), 2u);
  EXPECT_EQ(summary("all").at("planned_runs"), 6);
  Process part = evaluate(40, "part", with({"--merge", (dir_ / "one").string()}));
  EXPECT_EQ(part.wait(60s), exit_status::kFailed);
  EXPECT_NE(part.errors().find("3 of 6 runs are in none of these folders: runs/"), std::string::npos) << part.errors();
}

TEST_F(Evaluate, ARefusedEvaluationLeavesItsFolderForTheCorrectedCommand) {
  Process wrong = evaluate(40, "e", {"--seeds", "1", "--vary", "robto:links=1"});
  ASSERT_EQ(wrong.wait(30s), exit_status::kConfiguration) << wrong.errors();
  EXPECT_TRUE(fs::is_empty(dir_ / "e"));
  Process right = evaluate(40, "e", {"--seeds", "1", "--vary", "noise.camera_sd=0,0.5"});
  ASSERT_EQ(right.wait(60s), exit_status::kOk) << right.errors();
  // Nothing is left of the folders that were made without --output.
  fs::create_directory(dir_ / "here");
  Process unnamed({"/bin/sh", "-c",
                   "cd " + (dir_ / "here").string() + " && exec " + program("constrictor") +
                       " evaluate ../40_ticks.yaml --manifest ../toys.yaml --seeds 1 --vary robto:links=1"});
  EXPECT_EQ(unnamed.wait(30s), exit_status::kConfiguration) << unnamed.errors();
  EXPECT_TRUE(fs::is_empty(dir_ / "here"));
  // What is there already stays, whatever else is asked of it.
  Process later = evaluate(40, "e", {"--seeds", "1", "--vary", "robto:links=1"});
  EXPECT_EQ(later.wait(30s), exit_status::kUsage) << later.errors();
  EXPECT_EQ(hashes("e").size(), 2u);
}

TEST_F(Evaluate, ARunThatFailsStopsNothingAndIsDoneAgain) {
  in_first_run("exit 78");
  Process first = evaluate(40, "e", {"--seeds", "1..2", "--jobs", "1"});
  EXPECT_EQ(first.wait(60s), exit_status::kSoftware) << first.output();
  EXPECT_EQ(summary("e").at("variants").at(0).at("errors"), 1);
  EXPECT_EQ(summary("e").at("variants").at(0).at("runs"), 2);
  Process again = evaluate(40, "e", {"--seeds", "1..2"});
  EXPECT_EQ(again.wait(60s), exit_status::kOk) << again.output() << again.errors();
  EXPECT_EQ(summary("e").at("variants").at(0).at("errors"), 0);
}

// A folder that has the name of a file's temporary copy makes it impossible to write the file.
TEST_F(Evaluate, AResultThatCannotBeWrittenStopsNothingAndIsDoneAgain) {
  in_first_run("mkdir " + (dir_ / "e/runs/as_given/seed_0001/outcome.json.part").string());
  Process first = evaluate(40, "e", {"--seeds", "1..3", "--jobs", "1"});
  EXPECT_EQ(first.wait(60s), EX_IOERR) << first.output() << first.errors();
  EXPECT_NE(first.output().find("seed 1: error: cannot write"), std::string::npos) << first.output();
  EXPECT_NE(first.errors().find("the results of 1 run are lost"), std::string::npos) << first.errors();
  EXPECT_NE(first.errors().find("then the same command with --output"), std::string::npos) << first.errors();
  EXPECT_EQ(summary("e").at("variants").at(0).at("errors"), 1);
  EXPECT_EQ(summary("e").at("variants").at(0).at("runs"), 3);
  EXPECT_NE(text("e/runs.csv").find("cannot write"), std::string::npos);
  const auto done = hashes("e");
  EXPECT_EQ(done.size(), 2u);
  Process again = evaluate(40, "e", {"--seeds", "1..3"});
  EXPECT_EQ(again.wait(60s), exit_status::kOk) << again.output() << again.errors();
  EXPECT_NE(again.output().find("2 runs done before, 1 left"), std::string::npos) << again.output();
  EXPECT_EQ(summary("e").at("variants").at(0).at("errors"), 0);
  EXPECT_EQ(hashes("e").size(), 3u);
}

TEST_F(Evaluate, ASummaryThatCannotBeWrittenIsShown) {
  fs::create_directories(dir_ / "e");
  Process begun = evaluate(40, "e", {"--seeds", "1"});
  ASSERT_EQ(begun.wait(60s), exit_status::kOk) << begun.errors();
  const std::vector<std::string> files{"index.html", "runs.csv", "summary.json"};
  for (const auto& file : files) {
    fs::remove(dir_ / "e" / file);
    fs::create_directories(dir_ / "e" / (file + ".part") / "content");
  }
  fs::create_directory(dir_ / "e/evaluation.json.part");  // the seeds are the same: it need not be written
  Process full = evaluate(40, "e", {"--seeds", "1"});
  EXPECT_EQ(full.wait(60s), EX_IOERR) << full.output();
  EXPECT_NE(full.output().find("as given"), std::string::npos) << "the table is on the terminal: " << full.output();
  for (const auto& file : files) EXPECT_NE(full.errors().find("e/" + file), std::string::npos) << full.errors();
  Process more = evaluate(40, "e", {"--seeds", "2"});
  EXPECT_EQ(more.wait(60s), EX_IOERR) << more.output();
  EXPECT_NE(more.errors().find("the evaluation cannot begin: cannot write"), std::string::npos) << more.errors();

  for (const auto& file : files) fs::remove_all(dir_ / "e" / (file + ".part"));
  Process again = evaluate(40, "e", {"--seeds", "1"});
  EXPECT_EQ(again.wait(60s), exit_status::kOk) << again.errors();
  EXPECT_EQ(summary("e").at("variants").at(0).at("runs"), 1);
}

TEST_F(Evaluate, RunsThatCannotBeMergedAreNamed) {
  Process part = evaluate(40, "part", {"--seeds", "1..2"});
  ASSERT_EQ(part.wait(60s), exit_status::kOk) << part.errors();
  fs::create_directories(dir_ / "all/runs/as_given");
  fs::copy(dir_ / "part/evaluation.json", dir_ / "all/evaluation.json");
  fs::create_symlink("nowhere", dir_ / "part/runs/as_given/seed_0001/broken");
  Process merge = evaluate(40, "all", {"--merge", (dir_ / "part").string()});
  EXPECT_EQ(merge.wait(60s), EX_IOERR) << merge.output();
  EXPECT_NE(merge.errors().find("seed_0001 was not copied"), std::string::npos) << merge.errors();
  EXPECT_EQ(summary("all").at("variants").at(0).at("runs"), 1) << "the other run was copied";
  EXPECT_FALSE(fs::exists(dir_ / "all/runs/as_given/seed_0001.part"));
}

TEST_F(Evaluate, RefusesWhatItCannotDo) {
  const auto refused = [&](std::vector<std::string> more, int status, const std::string& reason) {
    Process process = evaluate(40, "e", std::move(more));
    EXPECT_EQ(process.wait(30s), status) << reason;
    EXPECT_NE(process.errors().find(reason), std::string::npos) << process.errors();
  };
  refused({"--seeds", "3..1"}, exit_status::kUsage, "--seeds: found '3..1'");
  refused({"--seeds", ""}, exit_status::kUsage, "--seeds: found nothing, accepted seeds and ranges");
  refused({"--seeds="}, exit_status::kUsage, "--seeds");
  refused({"--vary", "noise.camera_sd=1", "--vary", "noise.camera_sd=2"}, exit_status::kUsage,
          "accepted each key once");
  refused({"--vary", "noise.camera_sd=0.5,0.5"}, exit_status::kUsage, "found the value 0.5 twice");
  refused({"--shard", "3/2"}, exit_status::kUsage, "--shard: found '3/2'");
  refused({"--vary", "noise"}, exit_status::kUsage, "--vary: found 'noise'");
  refused({"--vary", "robto:links=1"}, exit_status::kConfiguration, "did you mean 'robot'?");
  refused({"--merge", dir_.string()}, exit_status::kUsage, "holds no evaluation");
  Process begun = evaluate(40, "f", {"--seeds", "1"});
  ASSERT_EQ(begun.wait(30s), exit_status::kOk) << begun.errors();
  write("40_ticks.yaml", "# changed\n");
  Process other = evaluate(40, "f", {"--seeds", "1"});
  EXPECT_EQ(other.wait(30s), exit_status::kUsage);
  EXPECT_NE(other.errors().find("holds another evaluation: scenario has changed since"), std::string::npos)
      << other.errors();
  write("41_ticks.yaml", "# another\n");
  Process another = evaluate(41, "f", {"--seeds", "1"});
  EXPECT_EQ(another.wait(30s), exit_status::kUsage);
  EXPECT_NE(another.errors().find("holds another evaluation: it is of the scenario 40_ticks, and not of 41_ticks"),
            std::string::npos)
      << another.errors();
  fs::create_directory(dir_ / "full");
  write("full/file", "");
  Process full = evaluate(40, "full", {"--seeds", "1"});
  EXPECT_EQ(full.wait(30s), exit_status::kUsage);
  EXPECT_NE(full.errors().find("is not empty and holds no evaluation"), std::string::npos) << full.errors();
  Process file = evaluate(40, "full/file", {"--seeds", "1"});
  EXPECT_EQ(file.wait(30s), exit_status::kUsage);
  EXPECT_NE(file.errors().find("full/file cannot become a folder"), std::string::npos) << file.errors();
}

}  // namespace
}  // namespace constrictor::testing
