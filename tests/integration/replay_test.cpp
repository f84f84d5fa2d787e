// `constrictor replay` with real processes: recordings through components and onto DDS.
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "constrictor/topics.hpp"
#include "cyclone/domain_claim.hpp"
#include "integration/run_command_fixture.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/mcap_writer.hpp"
#include "recording/message_cdr.hpp"
#include "recording/recording_summary.hpp"

namespace constrictor::testing {
namespace {

using Edit = std::function<bool(const mcap::Channel&, std::string& cdr)>;

class Replay : public RunCommand {
 protected:
  Replay() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  int status_of(const std::vector<std::string>& arguments, const std::string& name = "constrictor") {
    std::vector<std::string> all = {program(name)};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Process process(all, environment_);
    const int status = process.wait(60s).value_or(-1);
    output_ = process.output() + process.errors();
    return status;
  }
  [[nodiscard]] fs::path recording(const std::string& run) const { return dir_ / run / "run.mcap"; }
  /// Copies a recording. `edit` may change a message, or leave it out by returning false.
  static void copy(const fs::path& from, const fs::path& to, const Edit& edit) {
    mcap::Reader reader(from);
    mcap::Writer writer(to, reader.contents().profile, reader.contents().library);
    mcap::Visitor visitor;
    visitor.attachment = [&](const mcap::Attachment& one) { writer.attach(one); };
    visitor.metadata = [&](const mcap::Metadata& one) { writer.add_metadata(one); };
    visitor.message = [&](const mcap::Channel& channel, const mcap::Message& message) {
      std::string cdr(mcap::text_of(message.data));
      if (!edit(channel, cdr)) return;
      const auto id = writer.add_channel(0, channel.topic, channel.message_encoding, channel.metadata);
      writer.write({id, message.sequence, message.log_time, message.publish_time, mcap::bytes_of(cdr)});
    };
    reader.read(visitor);
    writer.finish();
  }
  /// The messages of a recording: "TOPIC SEQUENCE" to the bytes.
  static std::map<std::string, std::string> messages_of(const fs::path& file) {
    std::map<std::string, std::string> messages;
    mcap::Visitor visitor;
    visitor.message = [&](const mcap::Channel& channel, const mcap::Message& message) {
      const auto info = std::find_if(topics::kInfos.begin(), topics::kInfos.end(),
                                     [&](const TopicInfo& one) { return one.name == channel.topic; });
      if (info == topics::kInfos.end()) return;
      const auto number = find_codec(info->type)->header(message.data)->sequence_number;
      messages[channel.topic + " " + std::to_string(number)] = mcap::text_of(message.data);
    };
    mcap::Reader(file).read(visitor);
    return messages;
  }
  std::string output_;
};

TEST_F(Replay, EveryComponentRepeatsARecordedRun) {
  // Without pixels: camera and perception make them again, and the output hashes show that they are the same.
  status_of({"run", "case_study", "--max-sim-time", "1", "--in-process", "--report", (dir_ / "r").string(), "--record",
             "--images", "recompute"});
  EXPECT_EQ(status_of({"replay", recording("r"), "--component", "all"}), 0) << output_;
  for (const char* name :
       {"physics", "camera", "perception", "guidance", "navigation", "control", "input", "planner", "report"}) {
    EXPECT_NE(("\n" + output_).find(std::string("\n") + name + ": "), std::string::npos) << name << output_;
  }
  EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 9) << output_;
  EXPECT_EQ(output_.find(": 0 steps"), std::string::npos) << output_;
  // The report draws the same figure again.
  EXPECT_EQ(status_of({"replay", recording("r"), "--component", "report", "--output", (dir_ / "again").string()}), 0)
      << output_;
  const auto content = [&](const std::string& file) {
    std::ifstream stream(dir_ / file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_GT(content("r/figure.png").size(), 10'000u);
  EXPECT_TRUE(content("r/figure.png") == content("again/figure.png"));
  EXPECT_EQ(content("r/mission.json"), content("again/mission.json"));
}

TEST_F(Replay, ComputesTheImagesOfARecordingAgain) {
  for (const char* images : {"on", "recompute"}) {
    status_of({"run", "case_study", "--max-sim-time", "0.6", "--in-process", "--report", (dir_ / images).string(),
               "--record", "--images", images});
  }
  const fs::path restored = dir_ / "restored.mcap";
  EXPECT_EQ(status_of({"replay", recording("recompute"), "--restore", restored.string()}), 0) << output_;
  // Images were rendered in the one run, and computed from the recording of the other one.
  const auto whole = messages_of(recording("on"));
  EXPECT_TRUE(whole.contains("camera/image 3"));
  EXPECT_GT(whole.at("camera/image 3").size(), 100'000u);
  EXPECT_EQ(status_of({"diff", recording("on"), restored.string()}), 0) << output_;
  EXPECT_EQ(messages_of(restored).size(), whole.size());
  EXPECT_EQ(messages_of(restored).at("camera/image 3").size(), whole.at("camera/image 3").size());
  EXPECT_EQ(status_of({"info", restored.string()}), 0) << output_;
  EXPECT_EQ(status_of({"replay", recording("on"), "--restore", (dir_ / "no.mcap").string()}), 78) << output_;
  EXPECT_NE(output_.find("accepted one with --images recompute"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"replay", recording("recompute"), "--restore", restored.string()}), exit_status::kUsage);
}

TEST_F(Replay, NamesTheFirstDifferenceOfAComponent) {
  ASSERT_EQ(run(60, "r", {"--record"}).wait(30s), exit_status::kOk);
  const auto replay = [&](const fs::path& file) { return status_of({"--replay", file, "control"}, "toy_host"); };
  EXPECT_EQ(replay(recording("r")), 0) << output_;
  // One output of tick 40 in the recording is another one.
  copy(recording("r"), dir_ / "changed.mcap", [](const mcap::Channel& channel, std::string& cdr) {
    if (channel.topic != topics::kJointCommand.name) return true;
    msg::JointCommand command = *message_of<msg::JointCommand>(mcap::bytes_of(cdr));
    if (command.header.tick != 40) return true;
    command.position_rad[0] += 1.0;
    cdr = cdr_of(command);
    return true;
  });
  EXPECT_EQ(replay(dir_ / "changed.mcap"), 1);
  EXPECT_NE(output_.find("first difference: tick 40, topic joint_command, field position_rad[0]"), std::string::npos)
      << output_;
  // One input is missing.
  copy(recording("r"), dir_ / "gap.mcap", [](const mcap::Channel& channel, std::string& cdr) {
    if (channel.topic != topics::kJointState.name) return true;
    return message_of<msg::JointState>(mcap::bytes_of(cdr))->header.tick != 30;
  });
  EXPECT_EQ(replay(dir_ / "gap.mcap"), 1);
  EXPECT_NE(output_.find("joint_state"), std::string::npos) << output_;
  EXPECT_NE(output_.find("is not in the recording"), std::string::npos) << output_;
  EXPECT_EQ(status_of({"info", dir_ / "gap.mcap"}), 1);
  EXPECT_NE(output_.find("1 of joint_state"), std::string::npos) << output_;
  // What cannot be replayed is refused with the reason.
  EXPECT_EQ(status_of({"--replay", recording("r"), "contro"}, "toy_host"), 78);
  EXPECT_NE(output_.find("did you mean 'control'"), std::string::npos) << output_;
}

TEST_F(Replay, RepeatsRunsAtRealTimePaceAndAfterAReset) {
  ASSERT_EQ(run(60, "realtime", {"--record", "--pace", "realtime"}).wait(30s), exit_status::kOk);
  Process launcher = run(200, "reset", {"--record", "--pace", "4x"});
  ASSERT_TRUE(eventually([&] { return status_of({"reset", "7"}) == 0; })) << output_;
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output();
  for (const char* name : {"realtime", "reset"}) {
    const RecordingSummary summary = summarise_recording(recording(name));
    EXPECT_EQ(summary.missing(), 0u) << name;
    EXPECT_EQ(summary.proven, std::string(name) == "reset");
    EXPECT_EQ(summary.epochs.size(), std::string(name) == "reset" ? 2u : 1u);
    EXPECT_EQ(summary.epochs.back().seed, std::string(name) == "reset" ? 7u : 1u);
    EXPECT_EQ(
        status_of({"--replay", recording(name), "physics", "navigation", "control", "planner", "report"}, "toy_host"),
        0)
        << output_;
    EXPECT_EQ(output_.find(": 0 steps"), std::string::npos) << output_;
  }
}

TEST_F(Replay, PublishesTheRecordedBytesAlsoForLateReaders) {
  ASSERT_EQ(run(75, "r", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  const auto original = messages_of(recording("r"));
  // The command chooses the domain: one that this test had found free could be taken by another test before it is used.
  Process replay = command({"replay", recording("r"), "--stay"});
  ASSERT_TRUE(replay.wait_for("replaying", 20s)) << replay.errors();
  const std::string said = replay.output(), before = "in DDS domain ";
  const std::string domain = std::to_string(std::stoul(said.substr(said.find(before) + before.size())));
  EXPECT_EQ(status_of({"replay", recording("r"), "--domain", domain}), 70) << "the domain is in use: " << output_;
  const std::string first = (dir_ / "first.mcap").string();
  ASSERT_EQ(status_of({"record", first, "--domain", domain, "--for", "2"}), 0) << output_;
  ASSERT_TRUE(replay.wait_for("messages of", 20s)) << replay.output();
  const std::string late = (dir_ / "late.mcap").string();
  ASSERT_EQ(status_of({"record", late, "--domain", domain, "--for", "0.5"}), 0) << output_;
  for (const auto& file : {first, late}) {
    const auto replayed = messages_of(file);
    for (const auto& [name, bytes] : replayed) {
      ASSERT_TRUE(original.contains(name)) << name;
      EXPECT_EQ(bytes, original.at(name)) << name;
    }
    EXPECT_TRUE(replayed.contains("joint_state 75")) << file;
  }
  for (const std::string name : {"pause", "end"}) {
    EXPECT_EQ(status_of({name, "--run", domain}), 70) << output_;
    EXPECT_NE(output_.find("--run: found " + domain + ", a replay, accepted a run"), std::string::npos) << output_;
  }
  EXPECT_GT(messages_of(first).size(), messages_of(late).size());
  replay.signal(SIGINT);
  EXPECT_EQ(replay.wait(20s), 0);
}

/// Runs a command on a terminal of its own: types `keys` when `prompt` has appeared, and returns its output.
std::string on_a_terminal(std::vector<std::string> arguments, const std::string& prompt, const std::string& keys) {
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  int terminal = -1;
  const pid_t pid = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (pid == 0) {
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  std::string output;
  bool typed = false;
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (std::chrono::steady_clock::now() < end) {
    pollfd readable{terminal, POLLIN, 0};
    if (::poll(&readable, 1, 100) <= 0) continue;
    char buffer[512];
    const ssize_t count = ::read(terminal, buffer, sizeof buffer);
    if (count <= 0) break;  // the command has ended
    output.append(buffer, static_cast<std::size_t>(count));
    if (typed || output.find(prompt) == std::string::npos) continue;
    typed = true;
    EXPECT_EQ(::write(terminal, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  ::kill(pid, SIGKILL);
  ::waitpid(pid, nullptr, 0);
  ::close(terminal);
  return output;
}

TEST_F(Replay, PausesAndMakesSingleTicksAtTheKeyboard) {
  ASSERT_EQ(run(40, "r", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  const std::vector<std::string> arguments = {program("constrictor"), "replay", recording("r"), "--paused", "--topic",
                                              "barrier/tick"};
  const std::string stepped = on_a_terminal(arguments, "paused", "sssq");
  EXPECT_NE(stepped.find("\n3 messages of 1 topic in"), std::string::npos) << stepped;
  const std::string continued = on_a_terminal(arguments, "paused", "s ");
  EXPECT_NE(continued.find("\n41 messages of 1 topic in"), std::string::npos) << continued;  // and the final tick
}

}  // namespace
}  // namespace constrictor::testing
