// `constrictor servo` on the pseudo-terminals of emulated servos.
#include <csignal>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class ServoCommand : public CliFixture {
 protected:
  ServoCommand() {
    write("bus.yaml", "ports: [{device: bus0, baud: 1000000}]\nservo: {model: xm540_w150}\njoints:\n" + joints() +
                          "imu: {id: 100}\n");
    emulator_.emplace(std::vector<std::string>{program("servo_emulator"), "--bus", (dir_ / "bus.yaml").string(),
                                               "--output", dir_.string()});
    EXPECT_TRUE(emulator_->wait_for("servos answer", 20s)) << emulator_->errors();
  }
  static std::string joints() {
    std::string text;
    for (int id = 1; id <= 23; ++id) text += "  - {id: " + std::to_string(id) + "}\n";
    return text;
  }
  int servo(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "servo");
    arguments.insert(arguments.begin() + 2, {"--port", (dir_ / "bus0").string(), "--baud", "1000000"});
    return command(std::move(arguments));
  }
  [[nodiscard]] bool says(const std::string& text) const { return output_.find(text) != std::string::npos; }

  /// Gives the emulator a command, and waits until it has obeyed.
  void order(const std::string& order) {
    std::ofstream(dir_ / "servo_emulator.commands") << order << std::endl;
    EXPECT_TRUE(emulator_->wait_for("obeys '" + order + "'", 20s)) << emulator_->errors();
  }
  [[nodiscard]] int count(const std::string& text) const {
    int found = 0;
    for (auto at = output_.find(text); at != std::string::npos; at = output_.find(text, at + 1)) ++found;
    return found;
  }

  std::optional<Process> emulator_;
};

TEST(Emulators, NameTheirRelease) {
  for (const char* name : {"servo_emulator", "camera_emulator"}) {
    Process process({program(name), "--version"});
    EXPECT_EQ(process.wait(20s), exit_status::kOk);
    EXPECT_EQ(process.output(), std::string(name) + " " + kVersion + "\n");
  }
}

TEST(ProgramsOfComponents, NameTheComponentThatTheyHost) {  // what `constrictor swap` shows
  Process process({program("servo_bus"), "camera", "--check"});
  EXPECT_EQ(process.wait(20s), exit_status::kConfiguration);
  EXPECT_NE(
      process.errors().find("servo_bus: found the component camera, accepted servo_bus: this program hosts nothing "
                            "else"),
      std::string::npos)
      << process.errors();
}

TEST_F(ServoCommand, OneEmulatorUsesAFolder) {
  const auto second = [this] {
    return Process({program("servo_emulator"), "--bus", (dir_ / "bus.yaml").string(), "--output", dir_.string()});
  };
  const auto port = std::filesystem::read_symlink(dir_ / "bus0");
  Process refused = second();
  EXPECT_EQ(refused.wait(20s), exit_status::kConfiguration) << refused.errors();
  EXPECT_NE(refused.errors().find("servo_emulator.commands belongs to an emulator that runs"), std::string::npos)
      << refused.errors();
  EXPECT_EQ(std::filesystem::read_symlink(dir_ / "bus0"), port);
  EXPECT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  order("voltage 3 11.5");

  emulator_->signal(SIGKILL);
  emulator_->wait(20s);
  emulator_ = second();
  EXPECT_TRUE(emulator_->wait_for("servos answer", 20s)) << emulator_->errors();
  order("voltage 3 11.5");
  EXPECT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  emulator_->signal(SIGTERM);
  EXPECT_EQ(emulator_->wait(20s), exit_status::kOk);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "servo_emulator.commands"));
}

TEST_F(ServoCommand, ScanListsWhoAnswersAtWhichBaudRate) {
  EXPECT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("at 1000000 bit/s: 24 devices")) << output_;
  EXPECT_TRUE(says("id  23  xm540_w150, firmware 46, position 2048, 12.0 V, 25 C, torque off, error: none")) << output_;
  EXPECT_TRUE(says("id 100  inertial unit")) << output_;
  const std::string port = (dir_ / "bus0").string();
  EXPECT_EQ(command({"servo", "scan", "--port", port, "--baud", "57600"}), exit_status::kFailed);
  EXPECT_TRUE(says("no servo answers")) << output_;
  EXPECT_EQ(command({"servo", "scan", "--port", port, "--baud", "12345"}), exit_status::kUsage);
  EXPECT_EQ(command({"servo", "scan", "--port", "/dev/no_such_port"}), exit_status::kSoftware);
  EXPECT_TRUE(says("is the adapter plugged in")) << output_;
}

TEST_F(ServoCommand, TheTorqueIsSwitchedWithoutAJump) {
  EXPECT_EQ(servo({"torque", "on"}), exit_status::kUsage) << "of which servo?";
  EXPECT_EQ(servo({"torque", "on", "--all"}), exit_status::kOk) << output_;
  EXPECT_EQ(servo({"monitor", "--id", "5", "--rounds", "2"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("   5      2048      0.0")) << output_;
  EXPECT_EQ(servo({"torque", "off", "--id", "5"}), exit_status::kOk) << output_;
  EXPECT_EQ(servo({"scan"}), exit_status::kOk);
  EXPECT_TRUE(says("id   5  xm540_w150, firmware 46, position 2048, 12.0 V, 25 C, torque off")) << output_;
  EXPECT_TRUE(says("id   6  xm540_w150, firmware 46, position 2048, 12.0 V, 25 C, torque on")) << output_;
}

TEST_F(ServoCommand, TheTorqueOfAllServosGoesOffWhateverAServoReports) {
  ASSERT_EQ(servo({"torque", "on", "--all"}), exit_status::kOk) << output_;
  order("error 8 1");
  order("id 3 3");  // it has the id of another servo now
  ASSERT_EQ(servo({"torque", "off", "--all"}), exit_status::kOk) << output_;
  order("heal 3");
  ASSERT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  EXPECT_EQ(count("torque off"), 23) << output_;

  ASSERT_EQ(servo({"torque", "on", "--all"}), exit_status::kOk) << output_;
  order("damage 0 0.05");  // most questions are asked three times without an answer that can be used
  EXPECT_EQ(servo({"torque", "off", "--all"}), exit_status::kSoftware) << output_;
  EXPECT_TRUE(says("have not confirmed that their torque is off")) << output_;
  order("mend 0");
  ASSERT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  EXPECT_EQ(count("torque off"), 23) << output_;
}

TEST_F(ServoCommand, AServoThatIsSilentDoesNotKeepTheOthersUnderTorque) {
  ASSERT_EQ(servo({"torque", "on", "--all"}), exit_status::kOk) << output_;
  order("silent 0");
  ASSERT_EQ(servo({"torque", "off", "--all"}), exit_status::kOk) << output_;
  EXPECT_EQ(count("torque off"), 22) << output_;
  EXPECT_EQ(servo({"torque", "off", "--id", "1"}), exit_status::kSoftware) << output_;
  EXPECT_TRUE(says("no answer")) << output_;
}

TEST_F(ServoCommand, TwoServosWithOneIdAreNamedAndNotChanged) {
  order("id 3 5");  // the servo with id 4 takes that of the next one
  EXPECT_EQ(servo({"scan"}), exit_status::kFailed) << output_;
  EXPECT_TRUE(says("24 devices")) << output_;
  EXPECT_TRUE(says("id   5  two devices answer with id 5: disconnect one of them")) << output_;
  EXPECT_TRUE(says("id  23  xm540_w150, firmware 46, position 2048")) << "the scan goes on: " << output_;
  for (const auto& refused : std::vector<std::vector<std::string>>{{"id", "--id", "5", "--to", "50"},
                                                                   {"baud", "--id", "5", "--to", "57600"},
                                                                   {"limits", "--id", "5", "--current", "1"},
                                                                   {"limits", "--all", "--current", "1"},
                                                                   {"zero", "--id", "5"},
                                                                   {"torque", "on", "--id", "5"},
                                                                   {"torque", "on", "--all"}}) {
    EXPECT_EQ(servo(refused), exit_status::kSoftware) << refused[0] << ": " << output_;
    EXPECT_TRUE(says("two devices answer with id 5")) << refused[0] << ": " << output_;
  }
  EXPECT_EQ(servo({"zero", "--id", "6"}), exit_status::kOk) << output_;
  order("heal 3");
  EXPECT_EQ(servo({"scan"}), exit_status::kOk) << output_;
  EXPECT_EQ(count("torque off"), 23) << output_;
  EXPECT_EQ(servo({"limits", "--all"}), exit_status::kOk) << output_;
  EXPECT_FALSE(says("current 1.00 A")) << output_;
}

TEST_F(ServoCommand, AServoThatCannotBeReadDoesNotEndTheScan) {
  order("damage 0 0.05");
  EXPECT_EQ(servo({"scan"}), exit_status::kFailed) << output_;
  EXPECT_TRUE(says("unreadable: ")) << output_;
  EXPECT_GT(count("  id "), 12) << output_;
}

TEST_F(ServoCommand, AnIdIsChangedOnlyToOneThatNobodyHas) {
  EXPECT_EQ(servo({"id", "--id", "7", "--to", "8"}), exit_status::kSoftware);
  EXPECT_TRUE(says("which another device")) << output_;
  EXPECT_EQ(servo({"id", "--id", "77", "--to", "78"}), exit_status::kSoftware);
  EXPECT_TRUE(says("no answer")) << output_;
  EXPECT_EQ(servo({"torque", "on", "--id", "7"}), exit_status::kOk) << output_;
  EXPECT_EQ(servo({"id", "--id", "7", "--to", "70"}), exit_status::kSoftware);
  EXPECT_TRUE(says("its torque is on")) << output_;
  EXPECT_EQ(servo({"torque", "off", "--id", "7"}), exit_status::kOk) << output_;
  EXPECT_EQ(servo({"id", "--id", "7", "--to", "70"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("servo 7 is now servo 70")) << output_;
  EXPECT_EQ(servo({"zero", "--id", "70"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("- {id: 70, zero_steps: 2048}")) << output_;
}

TEST_F(ServoCommand, ABaudRateIsChanged) {
  EXPECT_EQ(servo({"baud", "--id", "4", "--to", "12"}), exit_status::kUsage);
  EXPECT_EQ(servo({"baud", "--id", "4", "--to", "57600"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("servo 4 now has 57600 bit/s")) << output_;
  EXPECT_EQ(servo({"baud", "--id", "4", "--to", "57600"}), exit_status::kSoftware)
      << "it no longer receives at this rate";
}

TEST_F(ServoCommand, LimitsAreShownSetAndRefused) {
  EXPECT_EQ(servo({"limits", "--id", "3", "--current", "2.5"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("servo 3: current 2.50 A, temperature 80 C")) << output_;
  EXPECT_EQ(servo({"limits", "--id", "3", "--current", "9"}), exit_status::kUsage);
  EXPECT_TRUE(says("--current (register current_limit): found 9 A, accepted 0 to 5.50643 A")) << output_;
  EXPECT_EQ(servo({"limits", "--id", "3", "--temperature", "900"}), exit_status::kUsage);
  EXPECT_TRUE(says("--temperature (register temperature_limit): found 900 C, accepted 0 to 100 C")) << output_;
  EXPECT_EQ(servo({"limits", "--id", "3", "--current", "1", "--temperature", "250"}), exit_status::kUsage);
  EXPECT_EQ(servo({"limits", "--id", "3"}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("servo 3: current 2.50 A, temperature 80 C")) << "neither was written: " << output_;
  EXPECT_EQ(servo({"limits", "--id", "100"}), exit_status::kSoftware);
  EXPECT_TRUE(says("found inertial unit")) << output_;
}

}  // namespace
}  // namespace constrictor::testing
