// The parameter motion.travel.method, which names the method that moves the robot.
#include <gtest/gtest.h>

#include "unit/control/control_run.hpp"

namespace constrictor {
namespace {

/// Stands for the component `input`: from tick 50 on, the parameter motion.travel.method of control has this value.
ComponentFactory choosing_input(double value) {
  return testing::scripted_writer<msg::ParameterChange>(
      "input", topics::kParameterChange, [value](const Tick& tick, const auto& out) {
        if (tick.index != 40) return;
        msg::ParameterChange change{};
        std::snprintf(change.name, sizeof change.name, "control.motion.travel.method");
        change.value = value;
        change.effective_tick = 50;
        out.write(change);
      });
}

/// The method that moves a robot that drives on, with a straight body or with a U from tick 100 on.
std::string driving_method(double parameter, int ticks, bool to_u = false) {
  LocalRun run = make_run(
      [to_u](const Tick& tick, msg::DesiredTrajectory& desired) {
        set_motion(desired, "travel", 1);
        desired.speed_m_s = 0.63;
        if (to_u && tick.index >= 100) set_u(desired);
        return true;
      },
      make_control_factory(), {choosing_input(parameter)});
  run.advance(ticks);
  EXPECT_TRUE(run.latest(topics::kMotionStatus)->accepted);
  return run.latest(topics::kMotionStatus)->method;
}

TEST(Control, DrivesWithTheMethodOfTheParameter) {
  EXPECT_EQ(driving_method(1, 30), "undulation") << "before the change";
  for (std::size_t i = 0; i < drive_methods().size(); ++i)
    EXPECT_EQ(driving_method(static_cast<double>(i), 80), drive_methods()[i]);
  EXPECT_EQ(driving_method(99, 80), "undulation") << "a value without a name is refused";
}

TEST(Control, ABodyInAPostureDrivesByUndulation) {
  EXPECT_EQ(driving_method(1, 90, true), "sidewinding");
  EXPECT_EQ(driving_method(1, 110, true), "undulation");
}

TEST(Control, ARobotWithoutPitchJointsRefusesVerticalWaves) {
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  for (auto& joint : robot.joints) joint.axis = JointAxis::kYaw;
  const MethodRegistry registry;
  const YawChain flat(robot);
  msg::DesiredTrajectory straight{};
  for (const char* name : {"sidewinding", "rolling", "pitch_wave"})
    EXPECT_FALSE(registry.find(name)->accepts(straight, flat)) << name;
  for (const char* name : {"undulation", "concertina"}) EXPECT_TRUE(registry.find(name)->accepts(straight, flat));
}

TEST(Control, TheDriveMethodsExistAndAcceptAStraightBody) {
  const MethodRegistry registry;
  const YawChain chain(load_robot(data_path("components/lib/robot/mamba.yaml")));
  msg::DesiredTrajectory straight{};
  for (const auto& name : drive_methods()) {
    const ControlMethod* method = registry.find(name);
    ASSERT_TRUE(method) << name;
    EXPECT_TRUE(method->accepts(straight, chain)) << name;
  }
}

}  // namespace
}  // namespace constrictor
