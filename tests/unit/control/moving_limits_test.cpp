// Which robots control can move. The ways were measured (components/control/README.md).
#include "control/moving_limits.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "component/data_path.hpp"
#include "control/control_fit.hpp"

namespace constrictor {
namespace {

RobotModel mamba() { return load_robot(data_path("components/lib/robot/mamba.yaml")); }

/// mamba with another value of all its joints.
RobotModel with(double JointModel::*member, double value) {
  RobotModel robot = mamba();
  for (JointModel& joint : robot.joints) joint.*member = value;
  return robot;
}

std::string kind_of(const RobotModel& robot, const ControlConfig& config = {}) {
  const CheckVerdict verdict = judge_joints(robot, config);
  return !verdict.refusals.empty() ? "refused" : !verdict.warnings.empty() ? "warned" : "accepted";
}

TEST(MovingLimits, EachShippedRobotMoves) {
  for (const auto& entry : std::filesystem::directory_iterator(data_path("components/lib/robot"))) {
    if (entry.path().extension() != ".yaml") continue;
    const RobotModel robot = load_robot(entry.path());
    EXPECT_EQ(kind_of(robot, control_fitted_to(robot, {})), "accepted") << entry.path();
  }
}

TEST(MovingLimits, AMethodWithWhichTheRobotLosesItsPoseIsWarnedOf) {
  for (std::size_t i = 0; i < drive_methods().size(); ++i) {
    ControlConfig config = control_fitted_to(mamba(), {});
    config.travel.method = static_cast<std::uint8_t>(i);
    const std::string& method = drive_methods()[i];
    const char* expected = method == "undulation" || method == "sliding_mode" ? "accepted" : "warned";
    EXPECT_EQ(kind_of(mamba(), config), expected) << method;
    std::swap(config.travel.method, config.creep.method);
    EXPECT_EQ(kind_of(mamba(), config), expected) << method << " for small steps beside an object";
  }
}

TEST(MovingLimits, AreThoseThatWereMeasured) {
  struct Case {
    double JointModel::*member;
    double value;
    const char* kind;
  };
  for (const auto& [member, value, kind] : {Case{&JointModel::max_speed_rad_s, 0.1, "refused"},
                                            {&JointModel::max_speed_rad_s, 0.79, "refused"},
                                            {&JointModel::max_speed_rad_s, 0.9, "warned"},
                                            {&JointModel::max_speed_rad_s, 1.0, "accepted"},
                                            {&JointModel::max_torque_nm, 0.2, "refused"},
                                            {&JointModel::max_torque_nm, 0.44, "refused"},
                                            {&JointModel::max_torque_nm, 0.5, "warned"},
                                            {&JointModel::max_torque_nm, 0.6, "accepted"},
                                            {&JointModel::position_gain_nm_rad, 1.0, "refused"},
                                            {&JointModel::position_gain_nm_rad, 3.0, "warned"},
                                            {&JointModel::position_gain_nm_rad, 6.0, "accepted"},
                                            {&JointModel::max_rad, 0.15, "refused"},
                                            {&JointModel::max_rad, 0.2, "warned"},
                                            {&JointModel::max_rad, 0.25, "accepted"},
                                            {&JointModel::min_rad, -0.15, "refused"},
                                            {&JointModel::min_rad, -0.2, "warned"},
                                            {&JointModel::min_rad, -0.25, "accepted"}})
    EXPECT_EQ(kind_of(with(member, value)), kind) << value;
}

TEST(MovingLimits, NameKeyFoundAcceptedAndReason) {
  EXPECT_EQ(judge_joints(with(&JointModel::max_torque_nm, 0.2), {}).refusals.at(0),
            "the robot mamba does not move: joints.max_torque_nm: found 0.2, accepted at least 0.45: weaker joints do "
            "not push a body of this mass over the ground");
  EXPECT_EQ(judge_joints(with(&JointModel::min_rad, -0.1), {}).refusals.at(0),
            "the robot mamba does not move: joints.min_rad: found -0.1, accepted at most -0.18: its wave bends each "
            "joint to both sides");
  EXPECT_EQ(judge_joints(with(&JointModel::max_speed_rad_s, 0.9), {}).warnings.at(0),
            "the robot mamba hardly moves: joints.max_speed_rad_s: found 0.9, it moves well from 1: slower joints do "
            "not follow its wave, which a smaller wave.most_hz of control makes slower");
}

TEST(MovingLimits, WarnOfABodyThatIsTooLong) {
  RobotModel robot = mamba();
  robot.module_count = 50;
  robot.joints.resize(49, robot.joints.front());
  EXPECT_NE(judge_joints(robot, {}).warnings.at(0).find("module.count: found 50, missions succeed with up to 44"),
            std::string::npos);
}

TEST(MovingLimits, FollowTheMassAndTheWave) {
  RobotModel light = with(&JointModel::max_torque_nm, 0.2);
  light.module_mass_kg *= 0.25;
  EXPECT_EQ(kind_of(light), "accepted") << "a quarter of the weight, a quarter of the friction";
  ControlConfig slow;
  slow.most_hz = 0.3;
  EXPECT_EQ(kind_of(with(&JointModel::max_speed_rad_s, 0.5), slow), "accepted") << "a slower wave";
  RobotModel lame = mamba();
  lame.joints[6].max_torque_nm = 0.1;
  EXPECT_EQ(kind_of(lame), "accepted") << "the other joints move the robot";
  ControlConfig rolling;
  rolling.travel.method = 2;
  EXPECT_EQ(judge_joints(with(&JointModel::max_rad, 0.1), rolling).refusals.size(), 0u)
      << "only undulation was measured";
}

}  // namespace
}  // namespace constrictor
