// Recordings of the whole case study: every component repeats it, the images that were not recorded are the same, and
// recorders that are killed leave files that the official reader reads.
#include <random>

#include "integration/run_command_fixture.hpp"
#include "recording/recording_summary.hpp"
#include "support/project.hpp"
#include "unit/recording/node/reader.hpp"

namespace constrictor::testing {
namespace {

class LongRecording : public RunCommand {
 protected:
  LongRecording() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  int status_of(const std::vector<std::string>& arguments, std::chrono::seconds bound = 600s) {
    Process process = command(arguments);
    const int status = process.wait(bound).value_or(-1);
    output_ = process.output() + process.errors();
    return status;
  }
  std::string output_;
};

TEST_F(LongRecording, EveryComponentRepeatsTheCaseStudyAndItsImages) {
  for (const char* images : {"on", "recompute"}) {
    const std::string report = (dir_ / images).string();
    ASSERT_EQ(status_of({"run", "--seed", "1", "--report", report, "--record", "--images", images}), 0) << output_;
    EXPECT_NE(output_.find("nothing is missing"), std::string::npos) << output_;
    EXPECT_EQ(status_of({"replay", report + "/run.mcap", "--component", "all"}), 0) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 9) << output_;
    if (std::string(images) == "on") continue;
    EXPECT_EQ(state_hash("on"), state_hash("recompute"));
    EXPECT_EQ(status_of({"diff", (dir_ / "on").string(), report}), 0) << output_;
    // Every image of the mission, computed again, has the bytes of the recorded one.
    const std::string restored = (dir_ / "restored.mcap").string();
    EXPECT_EQ(status_of({"replay", report + "/run.mcap", "--restore", restored}), 0) << output_;
    EXPECT_EQ(status_of({"diff", (dir_ / "on" / "run.mcap").string(), restored}), 0) << output_;
  }
}

TEST_F(LongRecording, RecordersThatAreKilledLeaveReadableFiles) {
  const OfficialReader official(testing::source_path("tests/unit/recording/node"), testing::build_path());
  Process launcher = run(1'000'000, "r", {"--pace", "1x", "--in-process"});
  ASSERT_TRUE(eventually([&] { return members().size() == 1; })) << launcher.output();
  std::mt19937 random(20261122);
  for (int i = 0; i < 50; ++i) {
    const std::string file = (dir_ / ("killed" + std::to_string(i) + ".mcap")).string();
    Process recorder = command({"record", file});
    ASSERT_TRUE(recorder.wait_for("recording", 20s)) << recorder.errors();
    std::this_thread::sleep_for(std::chrono::milliseconds(1'000 + random() % 1'000));
    const auto killed = std::chrono::system_clock::now().time_since_epoch();
    recorder.signal(SIGKILL);
    recorder.wait(20s);
    const RecordingSummary summary = summarise_recording(file);
    ASSERT_EQ(summary.epochs.size(), 1u);
    EXPECT_EQ(summary.missing(), 0u);
    // At this pace there is a tick every 20 ms of wall time, which is the log time of this recording.
    EXPECT_GT(summary.end_ns, static_cast<std::uint64_t>(std::chrono::nanoseconds(killed - 1s).count()));
    EXPECT_GT(official.read(file, true).back()["counts"]["barrier/tick"].get<int>(), 20);
    EXPECT_EQ(status_of({"recover", file}), 0) << output_;
    EXPECT_EQ(official.read(file).back()["statistics"]["messages"], summary.messages);
  }
  launcher.signal(SIGKILL);
  launcher.wait(30s);
  expect_nobody_left();
}

}  // namespace
}  // namespace constrictor::testing
