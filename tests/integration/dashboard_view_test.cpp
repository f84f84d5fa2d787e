// `constrictor run --view`: the dashboard begins and ends with the run.
#include "integration/run_command_fixture.hpp"
#include "support/web_socket.hpp"

namespace constrictor::testing {
namespace {

class DashboardView : public RunCommand {
 protected:
  DashboardView() {
    environment_["XDG_RUNTIME_DIR"] = dir_.string();
    environment_["DISPLAY"] = "";
    environment_["WAYLAND_DISPLAY"] = "";
  }
  static std::uint16_t port_in(const std::string& output) {
    const auto place = output.find("shown at http://127.0.0.1:");
    return place == std::string::npos ? std::uint16_t{0}
                                      : static_cast<std::uint16_t>(std::stoi(output.substr(place + 26)));
  }
};

TEST_F(DashboardView, OpensTheBrowserAndEndsWithTheRun) {
  write("xdg-open", "#!/bin/sh\necho \"$@\" > " + (dir_ / "opened").string() + "\n");
  fs::permissions(dir_ / "xdg-open", fs::perms::owner_all);
  environment_["PATH"] = dir_.string() + ":/usr/bin:/bin";
  environment_["DISPLAY"] = ":99";
  Process launcher = run(1'000'000, "r", {"--in-process", "--pace", "1x", "--view", "--view-port", "0"});
  ASSERT_TRUE(launcher.wait_for("the run is shown at http://127.0.0.1:", 30s)) << launcher.errors();
  const std::uint16_t port = port_in(launcher.output());
  EXPECT_EQ(WebSocket(port).status, 101);
  const auto opened = [&] {
    std::string line;
    std::ifstream file(dir_ / "opened");
    std::getline(file, line);
    return line;
  };
  EXPECT_TRUE(eventually([&] { return !opened().empty(); }));
  EXPECT_EQ(opened(), "http://127.0.0.1:" + std::to_string(port));
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(60s), 130) << launcher.errors();
  EXPECT_EQ(WebSocket(port).status, 0) << "no process listens any more";
}

TEST_F(DashboardView, ATakenPortIsSaidAndTheRunGoesOn) {
  Process first = run(1'000'000, "first", {"--in-process", "--pace", "1x", "--view", "--view-port", "0"});
  ASSERT_TRUE(first.wait_for("the run is shown at http://127.0.0.1:", 30s)) << first.errors();
  const std::string port = std::to_string(port_in(first.output()));
  Process second = run(200, "second", {"--in-process", "--pace", "1x", "--view", "--view-port", port});
  EXPECT_EQ(second.wait(60s), exit_status::kOk) << second.errors();
  const std::string output = second.output() + second.errors();
  EXPECT_NE(output.find("cannot open port " + port), std::string::npos) << output;
  EXPECT_NE(output.find("the run goes on and is not shown"), std::string::npos) << output;
  // The launcher is killed: its dashboard must not stay.
  first.signal(SIGKILL);
  EXPECT_EQ(first.wait(20s), 128 + SIGKILL);
  EXPECT_TRUE(eventually([&] { return WebSocket(static_cast<std::uint16_t>(std::stoi(port))).status == 0; }));
  Process wrong = run(10, "wrong", {"--view-port", "0"});
  EXPECT_EQ(wrong.wait(20s), exit_status::kUsage) << "--view-port needs --view";
}

}  // namespace
}  // namespace constrictor::testing
