// `run --record`, `record`, `info`, `recover` and `diff` with real processes: the components are toys, the barrier, the
// launcher and DDS are real.
#include <random>

#include "cli/recording/recorded_messages.hpp"
#include "cyclone/domain_claim.hpp"
#include "integration/run_command_fixture.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/recording_summary.hpp"

namespace constrictor::testing {
namespace {

class Recording : public RunCommand {
 protected:
  Recording() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  [[nodiscard]] fs::path recording(const std::string& run) const { return dir_ / run / "run.mcap"; }
  /// Expects that the recording has exactly the messages of the hash log, which is written independently of it.
  void expect_whole(const std::string& run) const {
    const RecordingSummary summary = summarise_recording(recording(run));
    EXPECT_TRUE(summary.proven) << summary.incomplete;
    EXPECT_EQ(summary.missing(), 0u);
    const auto logged = HashLog::read(dir_ / run);
    const auto recorded = cli::recorded_hashes(recording(run), true);
    ASSERT_EQ(recorded.size(), logged.size());
    for (std::size_t i = 0; i < logged.size(); ++i) {
      ASSERT_EQ(recorded[i].hash, logged[i].hash) << i;
      ASSERT_EQ(recorded[i].sequence_number, logged[i].sequence_number) << i;
    }
  }
  /// Exit status of a command, whose output is then in `output_`.
  int status_of(const std::vector<std::string>& arguments) {
    Process process = command(arguments);
    const int status = process.wait(30s).value_or(-1);
    output_ = process.output() + process.errors();
    return status;
  }
  std::string output_;
};

TEST_F(Recording, HasEveryMessageAndChangesNothing) {
  ASSERT_EQ(run(400, "plain").wait(30s), exit_status::kOk);
  ASSERT_EQ(run(400, "each", {"--record"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(400, "one", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(400, "forgetful", {"--record", "--no-checkpoints"}).wait(30s), exit_status::kOk);
  for (const char* name : {"each", "one", "forgetful"}) {
    EXPECT_EQ(state_hash(name), state_hash("plain")) << name;
    EXPECT_EQ(report(name)["recording"]["proven_complete"], true) << report(name)["recording"];
    EXPECT_FALSE(fs::exists(dir_ / name / "run.mcap.unwritten"));
    expect_whole(name);
  }
  EXPECT_FALSE(report("plain").contains("recording"));
  EXPECT_FALSE(fs::exists(recording("plain")));
  EXPECT_EQ(status_of({"diff", recording("each"), recording("one")}), 0) << output_;
  EXPECT_EQ(status_of({"info", recording("each")}), 0) << output_;
  EXPECT_NE(output_.find("nothing is missing"), std::string::npos) << output_;
  for (const char* name : {"scenario.yaml", "robot.yaml", "manifest.yaml", "versions.yaml"})
    EXPECT_NE(output_.find(name), std::string::npos) << output_;
}

TEST_F(Recording, IsWholeAfterThePlantWasKilledAtAnyTick) {
  ASSERT_EQ(run(300, "undisturbed", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(300, "r", {"--record", "--pace", "8x"});
  std::mt19937 random(20261122);
  int kills = 0;
  for (; kills < 4; ++kills) {
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 200'000));  // the kill comes at any moment
    pid_t dead = -1;
    if (!eventually([&] { return !launcher.running() || (dead = members()["physics"]) > 0; }) || dead <= 0) break;
    ::kill(dead, SIGKILL);
    ASSERT_TRUE(eventually([&] {
      const pid_t pid = members()["physics"];
      return !launcher.running() || (pid > 0 && pid != dead);
    }));
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << log("r", "physics");
  EXPECT_GE(kills, 3);
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  expect_whole("r");
  EXPECT_EQ(status_of({"diff", recording("r"), recording("undisturbed")}), 0) << output_;
}

TEST_F(Recording, IsContinuedWithTheRun) {
  ASSERT_EQ(run(250, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  {
    Process launcher = run(250, "r", {"--record", "--pace", "8x"});
    ASSERT_TRUE(eventually([&] { return fs::exists(recording("r")) && fs::file_size(recording("r")) > 10'000; }));
    launcher.signal(SIGKILL);
    launcher.wait(20s);
  }
  expect_nobody_left();
  EXPECT_EQ(status_of({"run", "--resume", (dir_ / "r").string()}), 0) << output_;
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  expect_whole("r");
}

TEST_F(Recording, EndsAtTheFullDiskAndTheRunGoesOn) {
  ASSERT_EQ(run(6000, "plain", {"--in-process"}).wait(30s), exit_status::kOk);
  // A limit of the size of files stands for the full disk. The other files of this run are smaller.
  write("6000_ticks.yaml", "");
  Process limited({"sh", "-c", "trap '' XFSZ; ulimit -f 4000; exec \"$@\"", "sh", program("constrictor"), "run",
                   (dir_ / "6000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(), "--report",
                   (dir_ / "r").string(), "--record", "--in-process"},
                  environment_);
  ASSERT_EQ(limited.wait(60s), exit_status::kOk) << limited.output();
  EXPECT_EQ(state_hash("r"), state_hash("plain"));
  const RecordingSummary summary = summarise_recording(recording("r"));
  EXPECT_EQ(summary.incomplete, "");
  ASSERT_TRUE(summary.dropped.contains("tick"));
  const auto tick = std::stol(summary.dropped.at("tick"));
  EXPECT_GT(tick, 500);
  EXPECT_LT(tick, 5999);
  EXPECT_FALSE(summary.proven);
  EXPECT_NE(limited.output().find("the recording ends at tick " + std::to_string(tick)), std::string::npos)
      << limited.output();
  EXPECT_NE(log("r", "physics+navigation+control+planner+report").find("the run goes on without it"),
            std::string::npos);
}

TEST_F(Recording, OfAnotherProcessCanBeReadAfterItWasKilled) {
  Process launcher = run(100'000, "r", {"--pace", "20x", "--in-process"});
  ASSERT_TRUE(eventually([&] { return members().size() == 1; })) << launcher.output();
  const std::string file = (dir_ / "live.mcap").string();
  {
    Process recorder = command({"record", file});
    ASSERT_TRUE(eventually([&] { return fs::exists(file) && fs::file_size(file) > 30'000; })) << recorder.errors();
    EXPECT_EQ(status_of({"record", file}), exit_status::kUsage) << "the file exists";
    EXPECT_EQ(status_of({"recover", file}), exit_status::kSoftware) << output_;
    EXPECT_NE(output_.find("another process is writing it"), std::string::npos) << output_;
    recorder.signal(SIGKILL);
    recorder.wait(20s);
  }
  EXPECT_EQ(status_of({"info", file}), 1) << output_;
  EXPECT_NE(output_.find("`constrictor recover` finishes it"), std::string::npos) << output_;
  const RecordingSummary cut = summarise_recording(file);
  EXPECT_EQ(status_of({"recover", file}), 0) << output_;
  const RecordingSummary recovered = summarise_recording(file);
  EXPECT_EQ(recovered.incomplete, "");
  EXPECT_EQ(recovered.messages, cut.messages);
  EXPECT_EQ(status_of({"recover", file}), 0) << output_;
  EXPECT_NE(output_.find("nothing to recover"), std::string::npos) << output_;
  // A recording that is ended in order has all that it was to have, and nothing else. Writers keep 16 steps for late
  // readers: at 20 times real time a reader that needs more than 16 ms for its start would miss messages.
  EXPECT_EQ(status_of({"pace", "1x"}), 0) << output_;
  const std::string chosen = (dir_ / "chosen.mcap").string();
  EXPECT_EQ(status_of({"record", chosen, "--topic", "joint_*", "--topic", "barrier/tick", "--for", "2"}), 0) << output_;
  const RecordingSummary summary = summarise_recording(chosen);
  ASSERT_EQ(summary.topics.size(), 3u);
  EXPECT_EQ(summary.topics[0].name, "barrier/tick");
  EXPECT_EQ(summary.topics[1].name, "joint_command");
  EXPECT_EQ(summary.topics[2].name, "joint_state");
  for (const auto& topic : summary.topics) {
    EXPECT_GT(topic.messages, 50u) << topic.name;
    EXPECT_EQ(topic.no_schema, "") << topic.name;
    EXPECT_EQ(topic.missing, 0u) << topic.name;
  }
  launcher.signal(SIGKILL);  // in order, the end would wait for the recorder that was killed
  launcher.wait(30s);
  expect_nobody_left();
}

TEST_F(Recording, OfAnotherProcessEndsWithTheRun) {
  Process launcher = run(500, "r", {"--pace", "5x", "--in-process"});
  ASSERT_TRUE(eventually([&] { return members().size() == 1; })) << launcher.output();
  Process recorder = command({"record", (dir_ / "all.mcap").string()});
  Process other = command({"record", (dir_ / "none.mcap").string(), "--topic", "joint_stat"});
  EXPECT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_TRUE(recorder.wait(20s)) << recorder.output();
  EXPECT_NE(recorder.output().find("the run has ended"), std::string::npos) << recorder.output();
  EXPECT_EQ(other.wait(20s), 1) << other.output();
  EXPECT_NE(other.errors().find("no message of a topic like joint_stat arrived"), std::string::npos) << other.errors();
}

TEST_F(Recording, IsNotReplacedBySurpriseAndNotCutByItsRecovery) {
  ASSERT_EQ(run(400, "r", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  const auto size = fs::file_size(recording("r"));
  EXPECT_EQ(run(50, "r", {"--in-process"}).wait(30s), exit_status::kUsage);
  EXPECT_EQ(fs::file_size(recording("r")), size);
  EXPECT_EQ(status_of({"replay", (dir_ / "r").string(), "--from", "999"}), exit_status::kUsage);
  EXPECT_NE(output_.find("--from: found 999 s, accepted 0 to"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"replay", (dir_ / "r").string(), "--topic", "joint_stat"}), exit_status::kUsage);
  EXPECT_NE(output_.find("--topic: found joint_stat"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"figure", (dir_ / "r").string(), "--format", "png", "-o", recording("r")}), exit_status::kUsage);
  EXPECT_NE(output_.find("a recording, accepted another file"), std::string::npos) << output_;

  const RecordingSummary whole = summarise_recording(recording("r"));
  {
    mcap::Reader reader(recording("r"));
    reader.read();
    const auto& chunks = reader.contents().chunks;
    const auto& chunk = chunks.at(chunks.size() / 2);
    std::fstream file(recording("r"), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(chunk.offset + chunk.length / 2));
    file << std::string(64, 'x');
  }
  EXPECT_EQ(status_of({"info", (dir_ / "r").string()}), exit_status::kSoftware) << output_;
  EXPECT_EQ(status_of({"recover", (dir_ / "r").string()}), exit_status::kOk) << output_;
  EXPECT_EQ(fs::file_size(recording("r").string() + ".damaged"), size);
  const RecordingSummary recovered = summarise_recording(recording("r"));
  EXPECT_EQ(recovered.incomplete, "");
  EXPECT_GT(recovered.messages, whole.messages / 2);
  EXPECT_EQ(status_of({"info", (dir_ / "r").string()}), 1) << "messages are missing\n" << output_;
  EXPECT_NE(output_.find("it was recovered: "), std::string::npos) << output_;

  EXPECT_EQ(run(50, "r", {"--in-process", "--force"}).wait(30s), exit_status::kOk);
  EXPECT_FALSE(fs::exists(recording("r")));
}

TEST_F(Recording, HasTopicsOfOtherProgramsAndSaysWhichHaveNoSchema) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"final", "its type contains a union"}, {"untyped", "its writer does not describe its type"}, {"appendable", ""}};
  for (const auto& [mode, why] : cases) {
    const DomainClaim claim;
    const std::string domain = std::to_string(claim.domain());
    Process talker({program("foreign_talker"), domain, mode}, environment_);
    const std::string file = (dir_ / (mode + ".mcap")).string();
    ASSERT_EQ(status_of({"record", file, "--domain", domain, "--for", "0.7"}), 0) << output_;
    EXPECT_EQ(status_of({"info", file}), 0) << output_;
    const RecordingSummary summary = summarise_recording(file);
    ASSERT_EQ(summary.topics.size(), 1u) << output_;
    EXPECT_GT(summary.topics[0].messages, 0u);
    EXPECT_EQ(summary.topics[0].no_schema, why);
    EXPECT_EQ(output_.find("bytes without schema: " + why) != std::string::npos, !why.empty()) << output_;
  }
}

TEST_F(Recording, DiffNamesTheFieldByTheRecordings) {
  ASSERT_EQ(run(50, "a", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(50, "b", {"--record", "--in-process", "--seed", "2"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(50, "c", {"--in-process"}).wait(30s), exit_status::kOk);
  const std::string expected = "first difference: tick 0, component physics, topic joint_state, field position_rad";
  for (const auto& pair : {std::pair(dir_ / "a", dir_ / "b"), std::pair(recording("a"), recording("b"))}) {
    EXPECT_EQ(status_of({"diff", pair.first, pair.second}), 1) << output_;
    EXPECT_EQ(output_.rfind(expected, 0), 0u) << output_;
  }
  EXPECT_EQ(status_of({"diff", recording("a"), (dir_ / "c").string()}), 70) << output_;
  EXPECT_NE(output_.find("found no run.mcap"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"info", (dir_ / "a" / "report.json").string()}), 70) << output_;
  EXPECT_NE(output_.find("is not an MCAP file"), std::string::npos) << output_;
}

}  // namespace
}  // namespace constrictor::testing
