// `constrictor record` beside a run of toys, and what observers of a run may not change.
#include "constrictor/topics.hpp"
#include "integration/run_command_fixture.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/recording_summary.hpp"

namespace constrictor::testing {
namespace {

class RecordCommand : public RunCommand {
 protected:
  RecordCommand() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  int status_of(const std::vector<std::string>& arguments) {
    Process process = command(arguments);
    const int status = process.wait(30s).value_or(-1);
    output_ = process.output() + process.errors();
    return status;
  }
  static void end(Process& launcher) {
    launcher.signal(SIGTERM);
    EXPECT_EQ(launcher.wait(30s), 128 + SIGTERM);
  }
  /// The attachments of a recording, by name.
  static std::map<std::string, std::string> attachments_of(const fs::path& file) {
    std::map<std::string, std::string> found;
    mcap::Visitor visitor;
    visitor.attachment = [&](const mcap::Attachment& one) { found[one.name] = one.data; };
    mcap::Reader reader(file);
    reader.read(visitor);
    return found;
  }
  static const RecordedTopic* topic_of(const RecordingSummary& summary, std::string_view name) {
    const auto found = std::find_if(summary.topics.begin(), summary.topics.end(),
                                    [&](const RecordedTopic& topic) { return topic.name == name; });
    return found == summary.topics.end() ? nullptr : &*found;
  }
  std::string output_;
};

// Nothing waits for a recorder that is started beside a run. These runs are slow, so that it misses nothing on a
// machine that is busy for a second.
TEST_F(RecordCommand, AttachesTheFilesOfARunOfThisHost) {
  const std::string file = (dir_ / "live.mcap").string();
  write("mine.yaml", "travel: {speed_m_s: 0.5}\n");
  Process launcher =
      run(100'000, "r",
          {"--pace", "0.2x", "--in-process", "--record", "--config", "navigation=" + (dir_ / "mine.yaml").string()});
  ASSERT_NE(domain_of(launcher), 0u);
  ASSERT_EQ(status_of({"record", file, "--for", "1"}), 0) << output_;
  end(launcher);
  auto expected = attachments_of(dir_ / "r" / "run.mcap");
  auto found = attachments_of(file);
  for (auto* files : {&expected, &found}) {
    EXPECT_NE((*files)["versions.yaml"].find("numeric_profile: "), std::string::npos) << (*files)["versions.yaml"];
    files->erase("versions.yaml");  // constrictor_host may have loaded other libraries than the toys
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found["configuration/navigation.yaml"], "travel: {speed_m_s: 0.5}\n");
  for (const char* name : {"scenario.yaml", "robot.yaml", "manifest.yaml", "configuration/control.yaml"})
    EXPECT_TRUE(found.contains(name)) << name;
}

TEST_F(RecordCommand, SaysThatARunOfAnotherHostHasNoFilesHere) {
  const std::string file = (dir_ / "live.mcap").string();
  Process launcher = run(100'000, "r", {"--pace", "2x", "--in-process"});
  const std::string domain = std::to_string(domain_of(launcher));
  ASSERT_NE(domain, "0");
  fs::create_directory(dir_ / "other_host");
  environment_["XDG_RUNTIME_DIR"] = (dir_ / "other_host").string();
  Process recorder = command({"record", file, "--domain", domain, "--for", "0.5"});
  EXPECT_TRUE(recorder.wait(30s));
  const std::string errors = recorder.errors();
  EXPECT_NE(errors.find("record: the recording has no attachments"), std::string::npos) << errors;
  EXPECT_NE(errors.find("started no run in DDS domain " + domain), std::string::npos) << errors;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  EXPECT_TRUE(attachments_of(file).empty());
  end(launcher);
}

TEST_F(RecordCommand, ExplainsWhichImagesItCanRecord) {
  EXPECT_EQ(status_of({"record", "live.mcap", "--images", "recompute"}), exit_status::kUsage);
  EXPECT_NE(output_.find("use `constrictor run --record --images recompute`"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"record", "live.mcap", "--images", "offf"}), exit_status::kUsage);
  EXPECT_NE(output_.find("found 'offf', accepted on, off, did you mean 'off'?"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"log", "--level", "wran"}), exit_status::kUsage);
  EXPECT_NE(output_.find("found 'wran', accepted info, warning, error, warn, did you mean 'warn'?"), std::string::npos)
      << output_;
  write("empty.mcap", "");
  EXPECT_EQ(status_of({"figure", (dir_ / "empty.mcap").string(), "--event", "object_graspd"}), exit_status::kUsage);
  EXPECT_NE(output_.find("did you mean 'object_grasped'?"), std::string::npos) << output_;
}

TEST_F(RecordCommand, KnowsNoRateOfSamplesThatWritersKept) {
  const std::string file = (dir_ / "live.mcap").string();
  Process launcher = run(100'000, "r", {"--pace", "0.4x"});
  ASSERT_NE(domain_of(launcher), 0u);
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  ASSERT_EQ(status_of({"status"}), 0) << output_;  // the run has begun
  ASSERT_EQ(status_of({"record", file, "--for", "2"}), 0) << output_;
  end(launcher);
  const RecordingSummary summary = summarise_recording(file);
  const RecordedTopic* hello = topic_of(summary, barrier_topics::kHello.name);
  ASSERT_TRUE(hello);
  EXPECT_GE(hello->history, 5u) << "each member has introduced itself before";
  EXPECT_EQ(hello->rate_hz(), 0.0);
  const RecordedTopic* joints = topic_of(summary, "joint_state");
  ASSERT_TRUE(joints);
  EXPECT_NEAR(joints->rate_hz(), 20.0, 4.0) << "50 Hz at 0.4 times the speed of the wall clock";
  ASSERT_EQ(status_of({"info", file}), 0) << output_;
  const auto line = output_.find(std::string(barrier_topics::kHello.name));
  ASSERT_NE(line, std::string::npos) << output_;
  EXPECT_NE(output_.substr(line, output_.find('\n', line) - line).find(" - "), std::string::npos) << output_;
}

TEST_F(RecordCommand, TheRecordingOfARunHasTheTopicOfAnExternalProgram) {
  Process launcher = run(400, "r", {"--record", "--pace", "2x", "--in-process"});
  const unsigned domain = domain_of(launcher);
  ASSERT_NE(domain, 0u);
  Process talker({program("foreign_talker"), std::to_string(domain), "appendable"}, environment_);
  EXPECT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  const RecordingSummary summary = summarise_recording(dir_ / "r" / "run.mcap");
  EXPECT_TRUE(summary.proven);
  const auto foreign = std::find_if(summary.topics.begin(), summary.topics.end(),
                                    [](const RecordedTopic& topic) { return topic.type.starts_with("foreign::"); });
  ASSERT_NE(foreign, summary.topics.end());
  EXPECT_GT(foreign->messages, 10u);
  EXPECT_EQ(foreign->no_schema, "");
}

TEST_F(RecordCommand, ObserversThatComeAndGoChangeNothing) {
  constexpr int kPairs = 4;
  constexpr int kKilled = 2;  // this pair ends by SIGKILL, the others by SIGINT
  ASSERT_EQ(run(1500, "alone", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(1500, "watched", {"--record", "--pace", "2x"});
  ASSERT_NE(domain_of(launcher), 0u);
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  std::vector<Process> before;  // of the pair before, so that two pairs overlap
  const auto end_pair = [&](int pair) {
    for (Process& one : before) {
      one.signal(pair == kKilled ? SIGKILL : SIGINT);
      EXPECT_TRUE(one.wait(20s)) << one.output();
    }
    before.clear();
  };
  for (int pair = 0; pair < kPairs; ++pair) {
    const fs::path file = dir_ / ("pair" + std::to_string(pair) + ".mcap");
    std::vector<Process> now;
    now.push_back(command({"record", file.string()}));
    now.push_back(command({"dashboard", "--port", "0"}));
    ASSERT_TRUE(now[1].wait_for("Ctrl-C ends the dashboard", 20s)) << now[1].errors();
    ASSERT_TRUE(eventually([&] { return fs::exists(file) && fs::file_size(file) > 20'000; })) << now[0].errors();
    end_pair(pair - 1);
    before = std::move(now);
  }
  ASSERT_TRUE(launcher.running()) << "the run must be longer than the pairs";
  end_pair(kPairs - 1);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("watched"), state_hash("alone"));
  EXPECT_EQ(report("watched")["recording"]["proven_complete"], true) << report("watched")["recording"];
  expect_nobody_left();
}

}  // namespace
}  // namespace constrictor::testing
