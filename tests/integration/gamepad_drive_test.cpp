// `constrictor teleop --gamepad` with the events of a gamepad in a FIFO, and files of parameters, in a real run.
#include <fcntl.h>
#include <linux/input.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class GamepadDrive : public CliFixture {
 protected:
  GamepadDrive() {
    write("blind.yaml", case_study_manifest(20, "  - {components: [physics, guidance, navigation, control, input]}\n"));
  }
  [[nodiscard]] Process begin() {
    Process run =
        start({"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "1x"});
    const std::vector<std::string> ready = {"param", "get", "navigation.travel.speed_m_s"};
    EXPECT_TRUE(eventually([&] { return domain() != 0 && command(ready) == 0; }, 30s)) << run.output() << run.errors();
    return run;
  }
  void press(int pad, std::uint16_t type, std::uint16_t code, std::int32_t value) const {
    input_event events[2] = {};
    events[0].type = type;
    events[0].code = code;
    events[0].value = value;
    events[1].type = EV_SYN;
    events[1].code = SYN_REPORT;
    ASSERT_EQ(::write(pad, events, sizeof(events)), static_cast<ssize_t>(sizeof(events)));
  }
  [[nodiscard]] std::string authority() {
    command({"topic", "echo", "authority", "-n", "1", "--field", "level"});
    return output_;
  }
  /// Waits until `text` has been printed `count` times.
  [[nodiscard]] static bool prints(const Process& process, const std::string& text, int count = 1) {
    return eventually([&] {
      const std::string output = process.output();
      int found = 0;
      for (auto at = output.find(text); at != std::string::npos; at = output.find(text, at + 1)) ++found;
      return found >= count;
    });
  }
};

TEST_F(GamepadDrive, TheRobotMovesOnlyWhileTheDeadManButtonIsHeld) {
  Process run = begin();
  const std::string fifo = (dir_ / "pad").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  Process teleop = start({"teleop", "--gamepad", fifo});
  ASSERT_TRUE(prints(teleop, "hold BTN_TL to move")) << teleop.output() << teleop.errors();
  int pad = ::open(fifo.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(pad, 0);

  press(pad, EV_ABS, ABS_Y, -32768);  // full speed forwards
  press(pad, EV_KEY, BTN_WEST, 1);    // wrap: it needs the dead-man button, too
  press(pad, EV_KEY, BTN_TL, 1);
  ASSERT_TRUE(prints(teleop, "\ndrive\n")) << teleop.output() << teleop.errors();
  EXPECT_EQ(teleop.output().find("wrap"), std::string::npos) << teleop.output();
  EXPECT_TRUE(eventually([&] { return authority().find("operator") != std::string::npos; })) << output_;
  command({"topic", "echo", "motion/command", "-n", "1", "--json"});
  EXPECT_EQ(json::parse(output_, nullptr, false).value("motion", ""), "drive") << output_;
  press(pad, EV_KEY, BTN_TL, 0);
  EXPECT_TRUE(prints(teleop, "\nstand\n")) << teleop.output();

  press(pad, EV_KEY, BTN_TL, 1);
  EXPECT_TRUE(prints(teleop, "\ndrive\n", 2)) << teleop.output();
  press(pad, EV_KEY, BTN_EAST, 1);
  EXPECT_TRUE(prints(teleop, "\nemergency stop\n")) << teleop.output();
  EXPECT_TRUE(eventually([&] { return authority().find("emergency") != std::string::npos; })) << output_;
  press(pad, EV_KEY, BTN_START, 1);
  EXPECT_TRUE(prints(teleop, "\nclear stop\n")) << teleop.output();
  press(pad, EV_ABS, ABS_RX, 20000);  // the dead-man button is still held since before the stop
  press(pad, EV_KEY, BTN_TL, 0);
  press(pad, EV_KEY, BTN_TL, 1);
  EXPECT_TRUE(prints(teleop, "\ndrive\n", 3)) << teleop.output();

  // The gamepad is unplugged while the robot moves.
  ::close(pad);
  EXPECT_TRUE(prints(teleop, "is gone: the robot stands until it is back")) << teleop.output();
  EXPECT_TRUE(prints(teleop, "\nstand\n", 2)) << teleop.output();
  pad = ::open(fifo.c_str(), O_WRONLY | O_CLOEXEC);
  press(pad, EV_ABS, ABS_Y, 32767);
  EXPECT_TRUE(prints(teleop, "is back")) << teleop.output();
  press(pad, EV_KEY, BTN_TL, 1);
  press(pad, EV_ABS, ABS_Y, 32766);
  press(pad, EV_ABS, ABS_Y, -32768);
  EXPECT_TRUE(prints(teleop, "\ndrive\n", 4)) << teleop.output();
  const std::string drives = teleop.output();
  EXPECT_EQ(drives.find("refused"), std::string::npos) << drives;

  teleop.signal(SIGINT);
  EXPECT_EQ(teleop.wait(10s), exit_status::kOk) << teleop.errors();
  EXPECT_NE(teleop.output().find("the robot stands, authority was released"), std::string::npos) << teleop.output();
  ::close(pad);

  // Every parameter is kept and loaded as a file; a file with mistakes changes nothing.
  const std::string tuned = (dir_ / "tuned.yaml").string();
  const std::string name = "navigation.travel.speed_m_s";
  ASSERT_EQ(command({"param", "set", name, "0.9"}), 0) << output_;
  EXPECT_TRUE(eventually([&] { return command({"param", "dump", tuned}) == 0; })) << output_;
  EXPECT_EQ(command({"param", "dump", tuned}), exit_status::kUsage) << "a tuned file is not replaced by accident";
  EXPECT_NE(output_.find("which exists, accepted a new file (or --force)"), std::string::npos) << output_;
  EXPECT_EQ(command({"param", "dump", tuned, "--force"}), 0) << output_;
  EXPECT_EQ(command({"param", "set", "navigation.travel.speeed_m_s", "0.5"}), exit_status::kFailed) << output_;
  EXPECT_NE(output_.find("did you mean 'navigation.travel.speed_m_s'?"), std::string::npos) << output_;
  ASSERT_EQ(command({"param", "set", name, "0.5"}), 0) << output_;
  const auto value = [&] {
    command({"param", "get", name, "--json"});
    return json::parse(output_, nullptr, false).value("value", 0.0);
  };
  EXPECT_TRUE(eventually([&] { return value() == 0.5; })) << output_;
  write("wrong.yaml", "navigation.travel.speed_m_s: 0.8\nnavigation.travel.speed_m_sz: 1\n");
  EXPECT_EQ(command({"param", "load", (dir_ / "wrong.yaml").string()}), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("wrong.yaml:2: navigation.travel.speed_m_sz: "), std::string::npos) << output_;
  EXPECT_EQ(value(), 0.5) << "nothing is set if anything is wrong";
  ASSERT_EQ(command({"param", "load", tuned}), 0) << output_;
  EXPECT_TRUE(output_.starts_with("run " + std::to_string(domain()) + ": " + name + ": 0.9 from tick ")) << output_;
  EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << "what is in force already is not set: " << output_;
  EXPECT_TRUE(eventually([&] { return value() == 0.9; })) << output_;
  EXPECT_EQ(command({"param", "load", (dir_ / "nowhere.yaml").string()}), exit_status::kConfiguration) << output_;

  // A task with --json, as scripts use it.
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left", "--timeout-s", "1", "--json"}), 0) << output_;
  const json started = json::parse(output_, nullptr, false);
  EXPECT_EQ(started["started"], "rotate") << output_;
  ASSERT_EQ(command({"task", "wait", "--end", "--goal", std::to_string(started["goal"].get<int>()), "--json"}), 0)
      << output_;
  const json end = json::parse(output_, nullptr, false);
  EXPECT_EQ(end["result"], "end") << output_;
  EXPECT_EQ(end["state"], "succeeded") << output_;
  EXPECT_EQ(end["goal_id"], started["goal_id"]) << output_;
  ASSERT_EQ(command({"task", "wait", "--event", "timeout", "--json"}), 0) << output_;
  EXPECT_EQ(json::parse(output_, nullptr, false)["event"], "timeout") << output_;
  ASSERT_EQ(command({"task", "cancel", "--json"}), 0) << output_;
  EXPECT_EQ(json::parse(output_, nullptr, false)["cancelled"], true) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  run.wait(10s);
}

TEST_F(GamepadDrive, RefusesWhatIsWrongBeforeItLooksForARun) {
  write("pad.yaml", "dead_man: BTN_TL\ndrive: {axis: ABS_SIDEWAYS, largest_m_s: 0.5}\n");
  EXPECT_EQ(command({"teleop", "--gamepad", "auto", "--mapping", (dir_ / "pad.yaml").string()}),
            exit_status::kConfiguration);
  EXPECT_NE(output_.find("pad.yaml:2: drive.axis: found 'ABS_SIDEWAYS', accepted"), std::string::npos) << output_;
  EXPECT_EQ(command({"teleop", "--mapping", (dir_ / "pad.yaml").string()}), exit_status::kUsage) << output_;
  EXPECT_EQ(command({"teleop", "--gamepad", "auto", "--drive", "1,0"}), exit_status::kUsage) << output_;
  EXPECT_EQ(command({"teleop", "--gamepad", "auto"}), exit_status::kSoftware) << "no run: " << output_;
}

}  // namespace
}  // namespace constrictor::testing
