// A fixture for tests of viewers that command a run of the real components.
#pragma once

#include "integration/cli_fixture.hpp"
#include "integration/dashboard_viewer.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {

using namespace std::chrono_literals;

/// A run without camera at twice the speed of the wall clock, and a dashboard beside it.
class DashboardRun : public CliFixture {
 protected:
  void SetUp() override {
    // No test here needs camera and perception, and the run is faster without them.
    write("blind.yaml", case_study_manifest(20, "  - {components: [physics, guidance, navigation, control, input]}\n"));
    std::vector<std::string> arguments = {
        "run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "2x"};
    for (const auto& option : run_options()) arguments.push_back(option);
    launcher_.emplace(start(arguments));
    ASSERT_TRUE(launcher_->wait_for("report in", 30s)) << launcher_->errors();
    watch();
  }
  /// Further options of `constrictor run`.
  [[nodiscard]] virtual std::vector<std::string> run_options() const { return {}; }
  /// Starts a dashboard of the only run or replay.
  void watch(const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments = {"dashboard", "--port", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    dashboard_.emplace(start(arguments));
    ASSERT_TRUE(dashboard_->wait_for("Ctrl-C ends the dashboard", 20s)) << dashboard_->errors();
    const std::string output = dashboard_->output();
    port_ = static_cast<std::uint16_t>(std::stoi(output.substr(output.find("127.0.0.1:") + 10)));
  }
  void end_run() {
    ASSERT_EQ(command({"end"}), exit_status::kOk) << output_;
    ASSERT_EQ(launcher_->wait(20s), 128 + SIGTERM);
    ASSERT_EQ(dashboard_->wait(20s), exit_status::kOk) << dashboard_->errors();
  }
  /// Ends the run, which must have the option --record, and watches its recording, which stands near its begin.
  void watch_recording() {
    end_run();
    replay_.emplace(start({"replay", (dir_ / "r" / "run.mcap").string(), "--paused"}));
    ASSERT_TRUE(replay_->wait_for("paused", 20s)) << replay_->errors();
    watch();
    // The components announce their parameters in their first steps.
    ASSERT_TRUE(Viewer(port_).ask("step", R"({"ticks":3})").starts_with("paused"));
  }
  void TearDown() override {
    if (!dashboard_) return launcher_->signal(SIGKILL);
    if (!replay_) return end_run();
    replay_->signal(SIGTERM);
    EXPECT_TRUE(replay_->wait(20s));
    EXPECT_EQ(dashboard_->wait(20s), exit_status::kOk) << dashboard_->errors();
  }
  std::optional<Process> launcher_, dashboard_, replay_;
  std::uint16_t port_ = 0;
};

}  // namespace constrictor::testing
