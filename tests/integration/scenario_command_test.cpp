// `constrictor scenario`: the examples of its help, what it writes, and what it refuses.
#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class ScenarioCommand : public RunCommand {
 protected:
  /// The state hash of the first second of a run with seed 5 in one process.
  [[nodiscard]] std::string state_hash(const std::string& scenario) const {
    const std::string folder = "report_of_" + fs::path(scenario).stem().string();
    Process process = command(
        {"run", scenario, "--seed", "5", "--max-sim-time", "1", "--in-process", "--report", (dir_ / folder).string()});
    process.wait(60s);  // the mission does not end within this time
    const nlohmann::json result = report(folder);
    EXPECT_TRUE(result.is_object()) << process.output() << process.errors();
    return result.is_object() ? result.value("state_hash", "") : "";
  }
};

TEST_F(ScenarioCommand, TheExamplesOfItsHelpWork) {
  EXPECT_EQ(run_examples({"scenario", "random"}), 2);
  EXPECT_NE(read("mine.yaml").find("\nname: random_hard_7\n"), std::string::npos) << read("mine.yaml");
  EXPECT_EQ(run_examples({"scenario", "show"}), 2);
  EXPECT_NE(read("straight.yaml").find("\nname: case_study_1\n"), std::string::npos) << read("straight.yaml");
  EXPECT_EQ(run_examples({"scenario"}), 2);
}

TEST_F(ScenarioCommand, TheWrittenFileGivesTheSameRunAsItsSeed) {
  Process drawn = command(
      {"scenario", "random", "--difficulty", "middle", "--seed", "5", "--output", (dir_ / "drawn.yaml").string()});
  ASSERT_EQ(drawn.wait(20s), exit_status::kOk) << drawn.errors();
  const std::string hash = state_hash("random_middle");
  EXPECT_NE(hash, "");
  EXPECT_EQ(state_hash((dir_ / "drawn.yaml").string()), hash);
  write("other.yaml", replaced(read("drawn.yaml"), "start: {position_m: [0, 0]", "start: {position_m: [0.01, 0]"));
  EXPECT_NE(state_hash((dir_ / "other.yaml").string()), hash) << "the hash must notice another scene";
}

TEST_F(ScenarioCommand, WritesTheSameToAFileAsToTheStandardOutput) {
  Process printed = command({"scenario", "show", "wide", "--seed", "7"});
  ASSERT_EQ(printed.wait(20s), exit_status::kOk) << printed.errors();
  EXPECT_TRUE(printed.output().starts_with("# The scene of wide with seed 7, drawn by Constrictor "))
      << printed.output();
  EXPECT_EQ(printed.output().find("\nvariation:"), std::string::npos);
  write("wide.yaml", "mine");
  const std::string file = (dir_ / "wide.yaml").string();
  Process refused = command({"scenario", "show", "wide", "--seed", "7", "--output", file});
  EXPECT_EQ(refused.wait(20s), exit_status::kUsage);
  EXPECT_EQ(refused.errors(),
            "constrictor: --output: found " + file + ", which exists, accepted a new file (or --force)\n");
  EXPECT_EQ(read("wide.yaml"), "mine");
  Process replacing = command({"scenario", "show", "wide", "--seed", "7", "--output", file, "--force"});
  EXPECT_EQ(replacing.wait(20s), exit_status::kOk) << replacing.errors();
  EXPECT_EQ(read("wide.yaml"), printed.output());
}

TEST_F(ScenarioCommand, RefusesWrongOptionsScenariosAndFiles) {
  struct Case {
    std::vector<std::string> options;
    int status;
    std::string said;
  };
  write("wrong.yaml", "name: wrong\n");
  write("crowded.yaml",
        "name: crowded\nmission: {sequence: [green], line_colour: blue}\n"
        "random: {line_length_m: [9, 9], bend_radius_m: [0.5, 0.5], bend_rad: [3, 3]}\n");
  const std::string missing = (dir_ / "no_such_folder" / "scene.yaml").string();
  const std::vector<Case> cases = {
      {{}, exit_status::kUsage, "subcommand"},
      {{"rondom"}, exit_status::kUsage, "random"},
      {{"random"}, exit_status::kUsage, "--difficulty is required"},
      {{"random", "--difficulty", "midle"}, exit_status::kUsage, "did you mean 'middle'?"},
      {{"random", "--difficulty", "easy", "--seed", "-1"}, exit_status::kUsage, "--seed"},
      {{"random", "--difficulty", "easy", "--output", missing}, exit_status::kUsage, "a folder that does not exist"},
      {{"random", "--difficulty", "easy", "--output", dir_.string(), "--force"},
       exit_status::kUsage,
       "no regular file"},
      {{"random", "--difficulty", "easy", "--output", "/dev/null", "--force"}, exit_status::kUsage, "no regular file"},
      {{"show"}, exit_status::kUsage, "SCENARIO is required"},
      {{"show", "wode"}, exit_status::kConfiguration, "did you mean 'wide'?"},
      {{"show", (dir_ / "wrong.yaml").string()}, exit_status::kConfiguration, "wrong.yaml:1: start: "},
      {{"show", (dir_ / "crowded.yaml").string()}, exit_status::kConfiguration, "found no scene for seed 1"},
  };
  for (const auto& [options, status, said] : cases) {
    std::vector<std::string> arguments = {"scenario"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Process refused = command(arguments);
    EXPECT_EQ(refused.wait(20s), status) << said << refused.output() << refused.errors();
    EXPECT_NE(refused.errors().find(said), std::string::npos) << said << " in: " << refused.errors();
    EXPECT_EQ(refused.output(), "") << said;
  }
}

TEST_F(ScenarioCommand, ReportsAFullDiskAndLeavesNothing) {
  Process printed({"/bin/sh", "-c", program("constrictor") + " scenario show wide > /dev/full"}, environment_);
  EXPECT_EQ(printed.wait(20s), exit_status::kSoftware);
  EXPECT_NE(printed.errors().find("the standard output: No space left on device"), std::string::npos)
      << printed.errors();
  // A limit of the size of files stands for the full disk; the message is smaller.
  const fs::path file = dir_ / "scene.yaml";
  Process written({"/bin/sh", "-c", "trap '' XFSZ; ulimit -f 1; exec \"$@\"", "sh", program("constrictor"), "scenario",
                   "show", "wide", "--output", file.string()},
                  environment_);
  EXPECT_EQ(written.wait(20s), exit_status::kSoftware);
  EXPECT_NE(written.errors().find("cannot write " + file.string() + ": File too large"), std::string::npos)
      << written.errors();
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

}  // namespace
}  // namespace constrictor::testing
