// Foxglove's real viewer (npm's @foxglove/studio-base) in headless Chromium, with the layout that the dashboard serves:
// it draws a run, the replay of a recording, and a recording as a file. Needs npm and the internet.
#include "integration/cli_fixture.hpp"
#include "support/npm_packages.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Steps = std::vector<std::string>;

/// The number behind these words; empty: there is none.
std::string number_behind(const std::string& text, const std::string& words) {
  const auto place = text.find(words);
  if (place == std::string::npos) return {};
  const auto begin = place + words.size();
  return text.substr(begin, text.find_first_not_of("0123456789", begin) - begin);
}

class FoxgloveViewer : public CliFixture {
 protected:
  static fs::path modules() { return build_path("foxglove_viewer"); }
  static void SetUpTestSuite() {
    install_npm_packages(source_path("tests/integration/node/viewer"), {"package.json"}, modules());
  }
  void SetUp() override {
    server_.emplace(
        Process({"node", source_path("tests/integration/node/viewer/server.mjs"), (modules() / "node_modules").string(),
                 source_path("components/tools/dashboard/page/foxglove_layout.json"), dir_.string()}));
    ASSERT_TRUE(server_->wait_for("port ", 20s)) << server_->errors();
    site_ = "http://127.0.0.1:" + number_behind(server_->output(), "port ");
  }
  void TearDown() override { server_->signal(SIGKILL); }
  /// Starts a dashboard of the only run or replay, which lets the viewer's page watch.
  void watch() {
    dashboard_.emplace(start({"dashboard", "--port", "0", "--allow-origin", site_}));
    ASSERT_TRUE(dashboard_->wait_for("Ctrl-C ends the dashboard", 20s)) << dashboard_->errors();
    live_ = "/?ds=foxglove-websocket&ds.url=ws://127.0.0.1:" + number_behind(dashboard_->output(), "127.0.0.1:");
  }
  /// Opens the viewer and carries out the steps.
  void browse(const std::string& source, const Steps& steps) {
    Steps arguments{"/usr/bin/env", "node", source_path("tests/support/browser.mjs"), site_ + source, "1600x1000"};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    arguments.push_back("view=" + (build_path("foxglove_viewer") / (name_of_test() + ".png")).string());
    Process browser(std::move(arguments));
    EXPECT_EQ(browser.wait(400s), 0) << browser.errors();
    problems_ = browser.output();
  }
  static std::string name_of_test() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }

  std::optional<Process> server_, dashboard_;
  std::string site_, live_, problems_;
};

std::string panel(const std::string& id) { return "[data-testid$=\"" + id + "\"]"; }

std::string in_log(const std::string& words) {
  return "wait=document.querySelector('" + panel("RosOut!log") + "')?.innerText.includes('" + words + "')";
}

/// Every panel of the layout shows what it is for.
Steps drawn() {
  return {"wait=window.started",
          "colours=100 " + panel("3D!scene") + " canvas",                  // the scene with its shading
          "shows=255,230,51 " + panel("ImageViewPanel!camera"),            // the line that perception found
          "colours=200 " + panel("ImageViewPanel!camera"),                 // on the camera's image
          "shows=242,142,43 " + panel("Plot!torques"),                     // the torque of joint 4
          "colours=10 " + panel("StateTransitions!mission") + " canvas"};  // states as coloured bars
}

/// What the viewer has to complain about.
const std::string kProblems = "print=document.body.innerText.match(/No problems found|.*(error|invalid|fail).*/gi)";
const std::string kPlayUntilTheLineIsFollowed =
    "wait=(document.querySelector('button[title=Play]')?.click(), document.querySelector('" + panel("RosOut!log") +
    "')?.innerText.includes('follow_line: goal running'))";
const std::string kPause =
    "wait=(button => button && (button.click(), true))(document.querySelector('button[title=Pause]'))";
const std::string kOpenProblems =
    "wait=(tab => tab && (tab.click(), true))"
    "([...document.querySelectorAll('[role=tab]')].find(tab => tab.textContent === 'Problems'))";

TEST_F(FoxgloveViewer, DrawsARun) {
  // The line is in sight for a long time: a busy machine needs a minute to load the viewer.
  Process run = start({"run", "--pace", "1x", "--in-process", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(run.wait_for("report in", 30s)) << run.errors();
  watch();
  Steps steps = drawn();
  steps.insert(steps.end(), {in_log("goal"), kOpenProblems, kProblems});
  browse(live_, steps);
  EXPECT_EQ(problems_, "[\"No problems found\"]\n");
  EXPECT_EQ(command({"end"}), 0) << output_;
  EXPECT_TRUE(run.wait(20s));
  EXPECT_TRUE(dashboard_->wait(20s));
}

TEST_F(FoxgloveViewer, DrawsARecordingThatIsReplayedOrOpenedAsAFile) {
  Process run = start({"run", "line", "--in-process", "--record", "--report", (dir_ / "r").string()});
  ASSERT_EQ(run.wait(120s), 0) << run.output() << run.errors();

  Process replay = start({"replay", (dir_ / "r" / "run.mcap").string(), "--speed", "0.2"});
  ASSERT_TRUE(replay.wait_for("replay", 20s)) << replay.errors();
  watch();
  Steps steps = drawn();
  steps.insert(steps.end(), {kOpenProblems, kProblems});
  browse(live_, steps);
  EXPECT_EQ(problems_, "[\"No problems found\"]\n");
  replay.signal(SIGTERM);
  EXPECT_TRUE(replay.wait(20s));
  EXPECT_TRUE(dashboard_->wait(20s));

  ASSERT_EQ(command({"foxglove", (dir_ / "r").string(), "--output", (dir_ / "seen.mcap").string()}), 0) << output_;
  // It is played until the robot follows the line. While the viewer opens a file, it forgets that it shall play, and
  // panels that come late stay empty.
  steps = {"wait=window.started", kPlayUntilTheLineIsFollowed, kPause};
  for (const auto& step : drawn()) steps.push_back(step);
  steps.insert(steps.end(), {kOpenProblems, kProblems});
  browse("/?ds=remote-file&ds.url=" + site_ + "/files/seen.mcap", steps);
  EXPECT_EQ(problems_, "[\"No problems found\"]\n");
}

}  // namespace
}  // namespace constrictor::testing
