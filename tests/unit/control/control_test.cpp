// The component in an in-process run, with ideal servos as the plant and a scripted trajectory.
#include "control/control.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "control/wave_motion.hpp"
#include "robot/trajectory_path.hpp"
#include "unit/control/control_run.hpp"

namespace constrictor {
namespace {

TEST(Control, HoldsTheMeasuredPostureBeforeTheFirstTrajectory) {
  LocalRun run = make_run([](const Tick&, msg::DesiredTrajectory&) { return false; });
  run.advance(20);
  const auto& command = *run.latest(topics::kJointCommand);
  EXPECT_NEAR(command.position_rad[6], 0.4, 1e-12);
  EXPECT_GT(command.torque_limit_nm[6], 0.0);
  EXPECT_FALSE(run.latest(topics::kMotionStatus)->accepted);
}

/// An added method: bends joint 0 by the yaw of the estimated pose, in one direction during a touch and in the other
/// direction without one.
class Feeler : public ControlMethod {
 public:
  [[nodiscard]] std::string_view name() const override { return "feeler"; }
  MethodProgress step(const MethodInput& input, BodyState&, Setpoints& setpoints) const override {
    if (!input.around.pose || !input.around.contacts || input.around.map) return {};  // this run has no map
    setpoints.position_rad[0] =
        input.around.contacts->contact_count > 0 ? input.around.pose->yaw_rad : -input.around.pose->yaw_rad;
    return {true, 1.0};
  }
};

/// Servos that touch something.
class TouchingServos : public IdealServos {
 public:
  TouchingServos(Wiring& wiring, const Setup& setup)
      : IdealServos(wiring, setup), contacts_(wiring.output(topics::kContactState)) {}
  void sample(const Tick& tick) override {
    IdealServos::sample(tick);
    msg::ContactState contacts{};
    contacts.contact_count = 1;
    contacts_.write(contacts);
  }

 private:
  Output<msg::ContactState> contacts_;
};

/// Stands for guidance: a pose with a yaw of 0.3 rad.
ComponentFactory estimate() {
  return testing::scripted_writer<msg::RobotPose>("guidance", topics::kRobotPose, [](const Tick&, const auto& out) {
    msg::RobotPose pose{};
    pose.yaw_rad = 0.3;
    out.write(pose);
  });
}

TEST(Control, PassesSensesToAnAddedMethod) {
  LocalRun run = make_run<TouchingServos>(
      [](const Tick&, msg::DesiredTrajectory& desired) {
        set_motion(desired, "feeler", 1);
        return true;
      },
      make_control_factory({[]() -> std::unique_ptr<ControlMethod> { return std::make_unique<Feeler>(); }}),
      {estimate()});
  run.advance(100);
  EXPECT_TRUE(run.latest(topics::kMotionStatus)->accepted);
  const msg::JointCommand& command = *run.latest(topics::kJointCommand);
  EXPECT_NEAR(command.position_rad[0], 0.3, 1e-9);
  EXPECT_EQ(run.latest(topics::kMotionStatus)->progress, 1.0);
  // The method writes the angle of joint 0 only.
  EXPECT_NEAR(command.position_rad[6], 0.4, 1e-12) << "a joint that a method leaves out keeps its posture";
  for (int j = 0; j < 23; ++j)
    EXPECT_EQ(command.torque_limit_nm[j], 6.0) << "the robot's own limit applies to joint " << j;
}

/// An added method: undulation with half of the amplitude.
class Gentle : public PostureMethod {
 public:
  [[nodiscard]] std::string_view name() const override { return "gentle"; }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    Gait gait = input.gait;
    gait.amplitude_rad *= 0.5;
    return PostureMethod::step(input.with_gait(gait), body, setpoints);
  }

 protected:
  MethodProgress progress(double, BodyState&) const override { return {}; }
};

// On a straight path the angles of the gait's equation (README.md) are proportional to its amplitude.
TEST(Control, AnAddedMethodVariesTheGait) {
  const auto command_of = [](const char* method) {
    LocalRun run = make_run(
        [method](const Tick&, msg::DesiredTrajectory& desired) {
          set_motion(desired, method, 1);
          desired.speed_m_s = 0.1;
          return true;
        },
        make_control_factory({[]() -> std::unique_ptr<ControlMethod> { return std::make_unique<Gentle>(); }}));
    run.advance(400);
    EXPECT_STREQ(run.latest(topics::kMotionStatus)->method, method);
    return *run.latest(topics::kJointCommand);
  };
  const msg::JointCommand whole = command_of("undulation");
  const msg::JointCommand half = command_of("gentle");
  double largest_rad = 0.0;
  for (int j = 0; j < 23; ++j) {
    EXPECT_NEAR(half.position_rad[j], 0.5 * whole.position_rad[j], 1e-9) << "joint " << j;
    largest_rad = std::max(largest_rad, std::abs(whole.position_rad[j]));
  }
  EXPECT_GT(largest_rad, 0.2);
}

/// A file of the project as text.
std::string text_of(const std::string& file) {
  std::ifstream stream(data_path(file));
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Control, EachMethodHasTheNameOfItsFileAndARowInTheReadme) {
  const std::string folder = "components/control/";
  const std::string readme = text_of(folder + "README.md");
  const auto names = MethodRegistry().names();
  EXPECT_GE(names.size(), 6u);
  for (const std::string_view method : names) {
    const std::string name(method);
    EXPECT_NE(text_of(folder + "methods/" + name + ".cpp").find(fmt::format("make_{}()", name)), std::string::npos)
        << name;
    EXPECT_NE(readme.find("\n| `" + name + "` | "), std::string::npos)
        << "the table of methods in components/control/README.md has no row for " << name;
  }
}

TEST(Control, HoldsPostureOnUnknownMethodAndOnInvalidShape) {
  LocalRun run = make_run([](const Tick& tick, msg::DesiredTrajectory& desired) {
    set_motion(desired, tick.index < 50 ? "moonwalk" : "undulation", 1);
    desired.speed_m_s = 0.63;
    desired.shape_count = tick.index < 50 ? 0 : 65535;  // more joints than the robot has
    return tick.index < 50;
  });
  run.advance(40);
  EXPECT_NEAR(run.latest(topics::kJointCommand)->position_rad[6], 0.4, 1e-12);
  EXPECT_STREQ(run.latest(topics::kMotionStatus)->method, "hold");
}

TEST(Control, HoldsThenRelaxesWhenTheTrajectoryIsStale) {
  LocalRun run = make_run([](const Tick& tick, msg::DesiredTrajectory& desired) {
    set_motion(desired, "undulation", 1);
    desired.speed_m_s = 0.63;
    return tick.index < 100;
  });
  run.advance(115);
  EXPECT_STREQ(run.latest(topics::kMotionStatus)->method, "hold");
  EXPECT_LT(largest_step_rad(run, 50), 1e-12);
  run.advance(250);
  EXPECT_STREQ(run.latest(topics::kMotionStatus)->method, "relax");
  EXPECT_EQ(run.latest(topics::kJointCommand)->torque_limit_nm[6], 0.0);
}

/// Stands for the component `input`: writes every 50 ticks that an operator has authority, and hangs from tick 200 on.
ComponentFactory hanging_input() {
  return testing::scripted_writer<msg::Authority>("input", topics::kAuthority, [](const Tick& tick, const auto& out) {
    if (tick.index % 50 != 0 || tick.index > 200) return;
    msg::Authority authority{};
    authority.level = msg::kAuthorityOperator;
    out.write(authority);
  });
}

TEST(Control, HoldsPostureWhenAuthorityIsNoLongerPublished) {
  LocalRun run = make_run(
      [](const Tick&, msg::DesiredTrajectory& desired) {
        set_motion(desired, "undulation", 1);
        desired.speed_m_s = 0.63;
        return true;
      },
      make_control_factory(), {hanging_input()});
  run.advance(340);
  EXPECT_GT(largest_step_rad(run, 5), 1e-4) << "a short silence must not stop the motion";
  run.advance(15);
  EXPECT_LT(largest_step_rad(run, 100), 1e-12);
}

TEST(Control, ChangesOfMethodDoNotJump) {
  LocalRun run = make_run([](const Tick& tick, msg::DesiredTrajectory& desired) {
    const auto phase = tick.index / 150;
    static constexpr const char* kMethods[] = {"undulation", "hold",    "bend",       "wrap",
                                               "squeeze",    "bend",    "undulation", "sidewinding",
                                               "concertina", "rolling", "undulation", "pitch_wave"};
    set_motion(desired, kMethods[phase % 12], static_cast<std::uint64_t>(phase));
    desired.speed_m_s = phase < 7 ? 0.63 : 0.45;
    set_arc(phase == 6 ? -1.0 : phase < 7 ? 0.5 : 0.2, desired);
    if (phase >= 3 && phase < 6) set_u(desired);
    desired.slide_m_s = 0.2;
    desired.squeeze_rad = 0.3;
    return true;
  });
  run.advance(1);
  // The servos allow 0.08 rad in a tick. The gait itself needs about 0.05 rad.
  EXPECT_LT(largest_step_rad(run, 1800), 0.07);
}

TEST(Control, WrapEndsInThePostureAndBendsHeadFirst) {
  LocalRun run = make_run([](const Tick&, msg::DesiredTrajectory& desired) {
    set_motion(desired, "wrap", 1);
    set_u(desired);
    desired.slide_m_s = 0.2;
    return true;
  });
  run.advance(100);
  EXPECT_GT(run.latest(topics::kJointCommand)->position_rad[0], 0.3);
  EXPECT_NEAR(run.latest(topics::kJointCommand)->position_rad[14], 0.0, 1e-9);
  run.advance(300);
  EXPECT_TRUE(run.latest(topics::kMotionStatus)->done);
  EXPECT_NEAR(run.latest(topics::kJointCommand)->position_rad[0], 0.0, 1e-6);
  for (int j : {10, 12, 14}) EXPECT_NEAR(run.latest(topics::kJointCommand)->position_rad[j], 1.047, 1e-6);
}

TEST(Control, TorqueLimitAppliesToTheBaseOfTheUOnly) {
  LocalRun run = make_run([](const Tick&, msg::DesiredTrajectory& desired) {
    set_motion(desired, "squeeze", 1);
    set_u(desired);
    desired.squeeze_rad = 0.5;
    desired.torque_limit_nm = 1.5;
    return true;
  });
  run.advance(600);
  const auto& command = *run.latest(topics::kJointCommand);
  EXPECT_EQ(command.torque_limit_nm[10], 1.5);
  EXPECT_EQ(command.torque_limit_nm[8], 6.0);
  EXPECT_TRUE(run.latest(topics::kMotionStatus)->done);
  EXPECT_NEAR(command.position_rad[12], 1.047 + 0.5 / 3.0, 1e-6);
  EXPECT_LT(command.position_rad[8], -0.05);
}

TEST(Control, ContinuesIdenticallyAfterARestart) {
  const Script script = [](const Tick& tick, msg::DesiredTrajectory& desired) {
    const bool wraps = tick.index >= 80 && tick.index < 200;
    set_motion(desired, tick.index < 80 ? "undulation" : wraps ? "wrap" : "sidewinding", tick.index < 80 ? 1 : 2);
    desired.speed_m_s = 0.63;
    desired.slide_m_s = 0.2;
    if (wraps) set_u(desired);
    return true;
  };
  LocalRun whole = make_run(script);
  LocalRun broken = make_run(script);
  whole.advance(300);
  broken.advance(123);
  broken.restart("control");
  broken.advance(100);
  broken.restart("control");  // while the waves of sidewinding grow
  broken.advance(77);
  EXPECT_EQ(whole.output_hashes().at("control"), broken.output_hashes().at("control"));
}

}  // namespace
}  // namespace constrictor
