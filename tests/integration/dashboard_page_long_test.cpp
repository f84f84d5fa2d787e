// The dashboard's page in headless Chromium, on a desktop and on a phone, with a run of the simulated robot.
#include "integration/run_command_fixture.hpp"
#include "support/project.hpp"

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
  [[nodiscard]] Process browse(const std::string& size, std::vector<std::string> steps,
                               const std::string& flags = "") const {
    std::vector<std::string> arguments{"/usr/bin/env", "node", testing::source_path("tests/support/browser.mjs"),
                                       "http://127.0.0.1:" + port_ + "/", size};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    return Process(std::move(arguments), {{"CONSTRICTOR_BROWSER_FLAGS", flags}});
  }
  static std::string answered(const std::string& text) {
    return "wait=document.querySelector('#answer').textContent.includes('" + text + "')";
  }
  std::optional<Process> launcher_, dashboard_;
  std::string port_;
};

constexpr const char* kConnected = "wait=document.querySelector('#connection').textContent === 'connected'";
/// An empty canvas has one colour.
const std::vector<std::string> kDrawn = {"colours=3 #camera", "colours=3 #processed", "colours=3 #torques",
                                         "colours=3 #history"};

std::vector<std::string> joined(std::vector<std::string> steps, const std::vector<std::string>& more) {
  steps.insert(steps.end(), more.begin(), more.end());
  return steps;
}

TEST_F(DashboardPage, DrawsTheRunAndItsButtonsCommandIt) {
  Process desktop =
      browse("1300x1000", joined({kConnected, "colours=30 #scene_3d", "wait=document.querySelector('#solid').checked",
                                  "wait=document.querySelectorAll('#processes tr').length === 9",
                                  "wait=document.querySelectorAll('#machine .present').length === 1", "click=#pause",
                                  answered("paused, next tick"), "click=#step", answered("step: paused, next tick"),
                                  "click=#resume", answered("running")},
                                 kDrawn));
  EXPECT_EQ(desktop.wait(120s), 0) << desktop.errors();
  Process phone =
      browse("390x844", {kConnected, "colours=30 #scene_3d", "wait=document.documentElement.scrollWidth <= 390",
                         "click=#stop", answered("the robot holds its posture"),
                         "wait=document.querySelector('#run').textContent.includes('EMERGENCY STOP')",
                         "click=#clear_stop", answered("emergency stop cleared"),
                         "wait=!document.querySelector('#run').textContent.includes('EMERGENCY STOP')"});
  EXPECT_EQ(phone.wait(120s), 0) << phone.errors();
}

TEST_F(DashboardPage, ThePadAndTheKeysDriveWhileTheyAreHeld) {
  Process page = browse(
      "1300x1000", {kConnected, "press=#pad", answered("m/s"),
                    "wait=document.querySelector('#authority').textContent.includes('dashboard.')",
                    "wait=document.querySelector('#state').textContent.includes('suspended')", "let",
                    answered("stands"), "click=#keys", "down=ArrowUp", answered("drive: 0.30 m/s, 0.00 rad/s"),
                    "down=ArrowLeft", answered("drive: 0.30 m/s, 1.00 rad/s"), "up=ArrowUp",
                    answered("drive: 0.00 m/s, 1.00 rad/s"), "up=ArrowLeft", answered("stands"), "click=#task_start",
                    answered("follow_line was accepted"), "click=#task_cancel", answered("the robot stands"),
                    "click=#parameters summary", "wait=document.querySelectorAll('#parameter_rows tr').length > 50",
                    ("print=(i => { i.value = '9999'; i.dispatchEvent(new Event('change')); })"
                     "(document.querySelector('#parameter_rows input'))"),
                    answered("accepted"), "click=#release", answered("released"), "print='handed back'",
                    // Another client changes a parameter, and the page shows it without being asked.
                    ("wait=[...document.querySelectorAll('#parameter_rows tr.changed input')].some("
                     "i => i.dataset.name === 'navigation.travel.speed_m_s' && i.value === '0.85')")});
  ASSERT_TRUE(page.wait_for("\"handed back\"", 240s)) << page.errors();
  Process changed = command({"param", "set", "navigation.travel.speed_m_s", "0.85"});
  EXPECT_EQ(changed.wait(20s), 0) << changed.errors();
  EXPECT_EQ(page.wait(120s), 0) << page.errors();
}

TEST_F(DashboardPage, ShowsTheSceneFromAboveWhereTheBrowserHasNoWebGl) {
  Process page = browse(
      "1300x1000",
      joined({kConnected, "wait=document.querySelector('#scene_note').textContent.includes('is shown from above')",
              "wait=document.querySelector('#solid').disabled", "colours=5 #scene_from_above"},
             kDrawn),
      "--disable-3d-apis");
  EXPECT_EQ(page.wait(120s), 0) << page.errors();
}

TEST_F(DashboardPage, ShowsARecordingWithATimeLine) {
  launcher_->signal(SIGINT);
  EXPECT_EQ(launcher_->wait(60s), 130) << launcher_->errors();
  ASSERT_EQ(dashboard_->wait(20s), 0);
  Process recorded = command(
      {"run", "case_study", "--max-sim-time", "12", "--in-process", "--record", "--report", (dir_ / "rec").string()});
  ASSERT_EQ(recorded.wait(240s), 1) << recorded.errors();
  // It begins with a pause and stays after its end, so that the browser may be slow. The scene comes last, because a
  // slow browser draws it when the recording has long ended, and then the button would begin it again.
  Process replay = command({"replay", (dir_ / "rec" / "run.mcap").string(), "--paused", "--stay"});
  ASSERT_TRUE(replay.wait_for("replaying", 30s)) << replay.errors();
  start_dashboard(port_);
  Process page =
      browse("390x844",
             {kConnected, "wait=document.querySelector('#place').textContent.includes('of 0:12.0')",
              "wait=document.querySelector('#operate').hidden", "click=#play", answered("resume: playing"),
              "wait=document.querySelector('#play').textContent === 'Pause'", "click=#play",
              answered("pause: paused at"), "click=#position", answered("seek: paused at 6.0 of 12.0"),
              "wait=document.querySelector('#run').textContent.includes(' 6.0 s')",
              "wait=document.querySelectorAll('#machine .present').length === 1",
              "wait=document.querySelector('#play').textContent === 'Play'", "click=#play", answered("resume: playing"),
              "wait=parseFloat(document.querySelector('#place').textContent.slice(2)) >= 8", "colours=30 #scene_3d",
              "wait=document.documentElement.scrollWidth <= 390"});
  EXPECT_EQ(page.wait(120s), 0) << page.errors();
  Process wide = browse("1300x1000", {kConnected, "wait=document.querySelector('#operate').hidden",
                                      "wait=document.querySelector('#events').clientWidth > 1200"});
  EXPECT_EQ(wide.wait(60s), 0) << wide.errors();
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

TEST_F(DashboardPage, SaysThatTheRunHasEnded) {
  Process page = browse("1300x1000", {kConnected, "print='connected'",
                                      "wait=document.querySelector('#connection').textContent === "
                                      "'the run has ended; waiting for the next one'"});
  ASSERT_TRUE(page.wait_for("\"connected\"", 60s)) << page.errors();
  launcher_->signal(SIGINT);
  EXPECT_EQ(page.wait(120s), 0) << page.errors();
}

}  // namespace
}  // namespace constrictor::testing
