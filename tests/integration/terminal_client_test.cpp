// `constrictor teleop` in a terminal (tmux): it obeys keys, draws its screen, and restores the terminal at its end.
#include <signal.h>
#include <unistd.h>

#include <optional>
#include <sstream>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class TerminalClient : public CliFixture {
 protected:
  TerminalClient() : socket_("constrictor-test-" + std::to_string(::getpid())) {
    write("blind.yaml", case_study_manifest(20, "  - {components: [physics, guidance, navigation, control, input]}\n"));
  }
  ~TerminalClient() override { tmux({"kill-server"}); }

  /// Starts a run, and a shell in a terminal of 80x24 that shows some text.
  void begin() {
    launcher_.emplace(start(
        {"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "1x"}));
    ASSERT_TRUE(launcher_->wait_for("simulated", 30s)) << launcher_->output() << launcher_->errors();
    tmux({"new-session", "-d", "-s", "robot", "-x", "80", "-y", "24", "sh"});
    enter("PS1='$ '; clear; echo was here before");
    ASSERT_TRUE(shows("was here before"));
  }

  std::string tmux(std::vector<std::string> arguments) const {
    std::vector<std::string> all = {"tmux", "-L", socket_, "-f", "/dev/null"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Process process(all, environment_);
    process.wait(10s);
    return process.output();
  }
  [[nodiscard]] std::string screen() const { return tmux({"capture-pane", "-p", "-t", "robot"}); }
  void type(const std::string& key) const { tmux({"send-keys", "-t", "robot", key}); }
  void enter(const std::string& line) const { tmux({"send-keys", "-t", "robot", line, "Enter"}); }
  [[nodiscard]] bool shows(const std::string& text, std::chrono::milliseconds bound = 20s) const {
    return eventually([&] { return screen().find(text) != std::string::npos; }, bound);
  }
  /// Types a key and expects that the screen then shows `text`.
  void expect_after(const std::string& key, const std::string& text) const {
    type(key);
    EXPECT_TRUE(shows(text)) << "key " << key << ": no \"" << text << "\" in\n" << screen();
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    std::ifstream stream(dir_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// Writes the terminal's settings to a file and waits until they are there.
  [[nodiscard]] std::string settings(const std::string& name) const {
    enter("stty -g > " + (dir_ / name).string() + "; touch " + (dir_ / name).string() + ".done");
    EXPECT_TRUE(eventually([&] { return fs::exists(dir_ / (name + ".done")); }, 10s)) << screen();
    return file(name);
  }

  std::string socket_;
  std::optional<Process> launcher_;
};

TEST_F(TerminalClient, KeysDriveTheRobotAndTheTerminalIsRestored) {
  begin();
  ASSERT_FALSE(HasFatalFailure());
  Process& launcher = *launcher_;
  const std::string before = settings("before");
  ASSERT_FALSE(before.empty());

  enter(program("constrictor") + " teleop");
  ASSERT_TRUE(shows("SPACE emergency stop")) << screen();
  ASSERT_TRUE(shows("authority  none")) << screen();
  ASSERT_TRUE(shows("a full bar is")) << screen();
  EXPECT_EQ(screen().find("was here before"), std::string::npos) << "teleop uses the alternate screen";
  std::istringstream lines(screen());
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_EQ(count, 24);

  type("i");
  EXPECT_TRUE(shows("granted: drive")) << screen();
  EXPECT_TRUE(shows("authority  operator teleop.")) << screen();
  EXPECT_TRUE(shows("(you)")) << screen();
  EXPECT_TRUE(shows("drive      +0.3 m/s")) << screen();
  EXPECT_TRUE(shows("(at most 1x")) << screen();
  expect_after("+", "+0.4 m/s");
  expect_after("Left", "turn +0.32 rad/s");  // the arrow key: an escape sequence

  expect_after("t", "task> _");
  enter("rotate direction=up");
  EXPECT_TRUE(shows("direction: found 'up'")) << screen();
  type("t");
  enter("rotate direction=left");
  EXPECT_TRUE(shows("rotate running")) << screen();

  expect_after("Space", "EMERGENCY STOP");
  expect_after("i", "REFUSED");
  expect_after("c", "authority  none");

  expect_after("q", "was here before");
  EXPECT_EQ(settings("after"), before);

  // SIGKILL gives teleop no chance to restore the terminal itself.
  enter(program("constrictor") + " teleop & echo $! > " + (dir_ / "pid").string() + "; fg");
  ASSERT_TRUE(shows("SPACE emergency stop")) << screen();
  ::kill(std::stoi(file("pid")), SIGKILL);
  EXPECT_TRUE(shows("was here before")) << screen();
  EXPECT_EQ(settings("killed"), before);
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  launcher.wait(10s);
}

TEST_F(TerminalClient, ReadsArrowsInBurstsAndPiecesAndLeavesARunThatIsGone) {
  begin();
  ASSERT_FALSE(HasFatalFailure());
  Process& launcher = *launcher_;
  const std::string before = settings("before");
  enter(program("constrictor") + " teleop");
  ASSERT_TRUE(shows("authority  none")) << screen();

  std::vector<std::string> burst = {"send-keys", "-t", "robot"};
  burst.insert(burst.end(), 30, "Up");
  tmux(burst);
  EXPECT_TRUE(shows("drive      +0.3 m/s  turn +0.00")) << screen();
  for (const char* byte : {"1b", "5b", "43"})
    tmux({"send-keys", "-t", "robot", "-H", byte});  // the right arrow in three pieces, as SSH may send it
  EXPECT_TRUE(shows("turn -0.24 rad/s")) << screen();
  type("Escape");
  type("k");
  EXPECT_TRUE(shows("granted: stand")) << screen();

  ASSERT_EQ(command({"status", "--json"}), exit_status::kOk) << output_;
  const auto status = nlohmann::json::parse(output_);
  const pid_t host = status["components"][0]["pid"];
  ::kill(host, SIGSTOP);
  EXPECT_TRUE(shows("SILENT for")) << screen();
  ::kill(host, SIGCONT);
  EXPECT_TRUE(eventually([&] { return screen().find("SILENT") == std::string::npos; })) << screen();

  launcher.signal(SIGKILL);  // its child processes die with it
  // The domain is free now: if a test beside this one has begun a run in it, the text goes on with that.
  EXPECT_TRUE(shows("teleop: the run has ended")) << screen();
  EXPECT_TRUE(shows("was here before")) << screen();
  EXPECT_EQ(settings("after"), before);
}

TEST_F(TerminalClient, AResizedTerminalAlwaysShowsTheEmergencyStop) {
  begin();
  ASSERT_FALSE(HasFatalFailure());
  enter(program("constrictor") + " teleop");
  ASSERT_TRUE(shows("a full bar is")) << screen();
  for (const auto& [columns, rows] : std::vector<std::pair<const char*, const char*>>{{"60", "18"}, {"40", "10"}}) {
    tmux({"resize-window", "-t", "robot", "-x", columns, "-y", rows});
    // The whole screen is drawn again: nothing of the old picture may be left.
    EXPECT_TRUE(eventually([&] {
      const std::string text = screen();
      return text.rfind("teleop  run", 0) == 0 && text.find("SPACE emergency stop") != std::string::npos &&
             text.find("a full bar is") == std::string::npos;
    })) << columns
        << "x" << rows << "\n"
        << screen();
  }
  tmux({"resize-window", "-t", "robot", "-x", "30", "-y", "8"});
  EXPECT_TRUE(shows("terminal too small")) << screen();
  type("Space");
  tmux({"resize-window", "-t", "robot", "-x", "80", "-y", "24"});
  EXPECT_TRUE(shows("EMERGENCY STOP")) << screen();
  EXPECT_TRUE(shows("a full bar is")) << screen();
  type("q");
  EXPECT_TRUE(shows("was here before")) << screen();
  EXPECT_TRUE(shows("teleop: the emergency stop of this program is latched"))
      << "teleop must print what happened to authority: " << screen();
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  launcher_->wait(10s);
}

TEST_F(TerminalClient, WithoutATerminalItNamesTheAlternatives) {
  Process launcher =
      start({"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  EXPECT_EQ(command({"teleop"}), exit_status::kSoftware);
  EXPECT_NE(output_.find("--drive"), std::string::npos) << output_;
  EXPECT_EQ(command({"teleop", "--drive", "fast"}), exit_status::kUsage);
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  launcher.wait(10s);
}

}  // namespace
}  // namespace constrictor::testing
