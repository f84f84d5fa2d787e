// The dashboard beside `constrictor replay`: viewers play, seek and step a recording.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "integration/dashboard_viewer.hpp"
#include "integration/run_command_fixture.hpp"
#include "recording/message_cdr.hpp"

namespace constrictor::testing {
namespace {

class DashboardReplay : public RunCommand {
 protected:
  DashboardReplay() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  void SetUp() override {
    ASSERT_EQ(run(500, "r", {"--in-process", "--record"}).wait(60s), exit_status::kOk);
    replay_.emplace(command({"replay", (dir_ / "r" / "run.mcap").string(), "--paused"}));
    ASSERT_TRUE(replay_->wait_for("paused", 20s)) << replay_->errors();
    dashboard_.emplace(command({"dashboard", "--port", "0"}));
    ASSERT_TRUE(dashboard_->wait_for("Ctrl-C ends the dashboard, not the replay", 20s)) << dashboard_->errors();
    const std::string output = dashboard_->output();
    port_ = static_cast<std::uint16_t>(std::stoi(output.substr(output.find("127.0.0.1:") + 10)));
  }
  /// The tick of the next sample of `joint_state` that arrives; -1: none.
  static std::int64_t next_tick(Viewer& viewer) {
    for (;;) {
      const auto message = viewer.receive(5s);
      if (!message) return -1;
      if (message->text || message->bytes.substr(0, 5) != std::string("\1\x4d\0\0\0", 5)) continue;
      const std::string cdr = message->bytes.substr(13);
      return find_codec("JointState")->header({reinterpret_cast<const std::uint8_t*>(cdr.data()), cdr.size()})->tick;
    }
  }
  std::optional<Process> replay_, dashboard_;
  std::uint16_t port_ = 0;
};

TEST_F(DashboardReplay, ViewersSeekStepAndPlayARecording) {
  Viewer watcher(port_), viewer(port_);
  const std::string begin = viewer.ask("seek", R"({"time_s":4})");
  ASSERT_TRUE(begin.starts_with("paused at 4.0 of ")) << begin;
  const std::uint32_t channel = watcher.channel_of("joint_state");
  ASSERT_GT(channel, 0u) << "what readers must know is published in the pause, too";
  ASSERT_TRUE(watcher.send_text(Viewer::subscribe(77, channel)));
  EXPECT_TRUE(viewer.ask("step", R"({"ticks":3})").starts_with("paused at 4.0"));
  std::int64_t tick = next_tick(watcher);
  EXPECT_NEAR(static_cast<double>(tick), 200, 3) << "4 s are 200 ticks of 20 ms";
  for (int i = 1; i <= 2; ++i) EXPECT_EQ(next_tick(watcher), tick + i);
  EXPECT_TRUE(viewer.ask("seek", R"({"time_s":1})").starts_with("paused at 1.0 of "));
  tick = next_tick(watcher);
  EXPECT_NEAR(static_cast<double>(tick), 50, 3) << "it goes back, too";
  EXPECT_TRUE(viewer.ask("pace", R"({"pace":4})").starts_with("paused at 1.0 of "));
  EXPECT_TRUE(viewer.ask("resume", "{}").starts_with("playing at 1."));
  for (int i = 1; i <= 50; ++i) ASSERT_EQ(next_tick(watcher), tick + i) << "nothing is left out";
  EXPECT_TRUE(viewer.ask("pace", R"({"pace":0})").starts_with("playing"));
  const auto at_the_end = [&] { return viewer.ask("pace", R"({"pace":0})").starts_with("at the end at "); };
  EXPECT_TRUE(eventually(at_the_end));
  EXPECT_TRUE(viewer.ask("resume", "{}").starts_with("playing at 0.0 of ")) << "once more";
  EXPECT_TRUE(viewer.ask("seek", R"({"time_s":1e6})").starts_with("playing at ")) << "beyond the end is the end";
  EXPECT_TRUE(eventually(at_the_end));
}

TEST_F(DashboardReplay, RefusesWhatARecordingCannotDoAndEndsWithTheReplay) {
  Viewer viewer(port_);
  EXPECT_EQ(viewer.ask("seek", R"({"time_s":-1})"), "failure: seek: accepted {\"time_s\": 0 to 1000000000}");
  EXPECT_EQ(viewer.ask("pace", R"({"pace":0.0001})").substr(0, 16), "failure: speed: ");
  EXPECT_EQ(viewer.ask("stop", "{}"), "failure: there is no service 0");
  Process status = command({"status"});
  EXPECT_EQ(status.wait(20s), exit_status::kSoftware) << "a replay is no run";
  EXPECT_EQ(status.output().find("replay of a recording in DDS domain "), 0u) << status.output();
  replay_->signal(SIGKILL);
  EXPECT_EQ(dashboard_->wait(20s), exit_status::kOk) << dashboard_->errors();
  EXPECT_NE(dashboard_->output().find("the replay has ended"), std::string::npos) << dashboard_->output();
  Process alone = command({"dashboard", "--port", "0"});
  EXPECT_EQ(alone.wait(20s), exit_status::kSoftware);
  EXPECT_NE(alone.errors().find("no run on this host"), std::string::npos) << alone.errors();
}

/// Leaves the file of a socket on which nobody listens, as a replay that is killed does.
void leave_socket(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(socket, 1), 0);
  ::close(socket);
}

TEST_F(RunCommand, ARunInTheDomainOfAKilledReplayIsNotTakenForTheReplay) {
  environment_["XDG_RUNTIME_DIR"] = dir_.string();
  Process run = this->run(100000, "r", {"--pace", "realtime"});
  const std::string domain = std::to_string(domain_of(run));
  leave_socket(dir_ / "constrictor" / ("replay-" + domain + ".sock"));
  Process status = command({"status"});
  EXPECT_EQ(status.wait(20s), exit_status::kOk);
  EXPECT_EQ(status.output().find("replay of"), std::string::npos) << status.output();
  for (const char* name : {"pause", "end"}) {
    Process one = command({name, "--run", domain});
    EXPECT_EQ(one.wait(20s), exit_status::kOk) << name << one.errors();
  }
  EXPECT_TRUE(run.wait(20s)) << run.errors();
}

}  // namespace
}  // namespace constrictor::testing
