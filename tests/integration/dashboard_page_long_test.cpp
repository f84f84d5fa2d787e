// The dashboard's page in headless Chromium, on a desktop and on a phone, with a run of the simulated robot.
#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class DashboardPage : public RunCommand {
 protected:
  DashboardPage() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  void SetUp() override {
    launcher_.emplace(command({"run", "short", "--pace", "2x", "--in-process", "--report", (dir_ / "r").string()}));
    ASSERT_GT(domain_of(*launcher_), 0u) << launcher_->errors();
    start_dashboard("0");
    const std::string output = dashboard_->output();
    port_ = output.substr(output.find("127.0.0.1:") + 10);
    port_.resize(port_.find(' '));
  }
  void start_dashboard(const std::string& port) {
    dashboard_.emplace(command({"dashboard", "--port", port}));
    ASSERT_TRUE(dashboard_->wait_for("Ctrl-C ends the dashboard", 20s)) << dashboard_->errors();
  }
  [[nodiscard]] Process browse(const std::string& size, std::vector<std::string> steps) const {
    std::vector<std::string> arguments{"/usr/bin/env", "node", CONSTRICTOR_SOURCE_DIR "/tests/support/browser.mjs",
                                       "http://127.0.0.1:" + port_ + "/", size};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    return Process(std::move(arguments));
  }
  static std::string answered(const std::string& text) {
    return "wait=document.querySelector('#answer').textContent.includes('" + text + "')";
  }
  std::optional<Process> launcher_, dashboard_;
  std::string port_;
};

constexpr const char* kConnected = "wait=document.querySelector('#connection').textContent === 'connected'";
/// The number of distinct colours on a canvas: an empty one has one.
constexpr const char* kColours =
    "wait=['scene', 'camera', 'processed', 'torques', 'history'].every(id => { const c = document.getElementById(id);"
    "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; const s = new Set();"
    "for (let i = 0; i < d.length; i += 4) s.add(d[i] << 16 | d[i + 1] << 8 | d[i + 2]); return s.size > 3; })";

TEST_F(DashboardPage, DrawsTheRunAndItsButtonsCommandIt) {
  Process desktop =
      browse("1300x1000", {kConnected, kColours, "wait=document.querySelectorAll('#processes tr').length === 9",
                           "wait=document.querySelectorAll('#states li.present').length === 1", "click=#pause",
                           answered("paused, next tick"), "click=#step", answered("step: paused, next tick"),
                           "click=#resume", answered("running")});
  EXPECT_EQ(desktop.wait(120s), 0) << desktop.errors();
  Process phone = browse("390x844", {kConnected, kColours, "wait=document.documentElement.scrollWidth <= 390",
                                     "click=#stop", answered("the robot holds its posture"),
                                     "wait=document.querySelector('#run').textContent.includes('EMERGENCY STOP')",
                                     "click=#clear_stop", answered("emergency stop cleared"),
                                     "wait=!document.querySelector('#run').textContent.includes('EMERGENCY STOP')"});
  EXPECT_EQ(phone.wait(120s), 0) << phone.errors();
}

TEST_F(DashboardPage, ShowsALostConnectionAndRecovers) {
  Process page =
      browse("1300x1000", {kConnected, "print='connected'",
                           "wait=document.querySelector('#connection').textContent.includes('not connected')",
                           "wait=document.querySelector('#stop').disabled", "print='lost'", kConnected,
                           "wait=!document.querySelector('#stop').disabled"});
  ASSERT_TRUE(page.wait_for("\"connected\"", 60s)) << page.errors();
  dashboard_->signal(SIGKILL);
  ASSERT_TRUE(page.wait_for("\"lost\"", 60s)) << page.errors();
  start_dashboard(port_);
  EXPECT_EQ(page.wait(120s), 0) << page.errors();
}

}  // namespace
}  // namespace constrictor::testing
