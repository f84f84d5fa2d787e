#include "control/moving_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "configuration/quantiles.hpp"
#include "control/control_method.hpp"
#include "robot/u_arms.hpp"

namespace constrictor {
namespace {

// Measured with `mamba` (README.md): with less than the first value it covers less than a twentieth of its usual way,
// and with less than the second one less than a quarter.
constexpr double kLeastRange_rad = 0.18, kEnoughRange_rad = 0.25;  // to each side
constexpr double kLeastTorque_nm = 0.45, kEnoughTorque_nm = 0.6;
// Missions `short`, three for each value: with 1 Nm/rad none succeeds, with 2 and with 3 one of three, from 6 on all.
constexpr double kLeastGain_nm_rad = 1.5, kEnoughGain_nm_rad = 6.0;
constexpr double kLeastRate = 0.17, kEnoughRate = 0.212;  // by the rate of the wave at its highest frequency

constexpr std::size_t kMostModules = 44;  // `short`: with 40 and 44 two missions of two succeed, with 50 and 60 none

/// A bound for a value of most yaw joints.
struct JointBound {
  const char* key;
  double JointModel::*member;
  double sign;    ///< -1: the robot file has a negative value, whose amount counts
  double least;   ///< with less the robot does not move
  double enough;  ///< with less it hardly moves
  const char* why;
};

/// The median, so that one weak joint does not count: the others move the robot.
double of_most_joints(const RobotModel& robot, double JointModel::*member) {
  std::vector<double> values;
  for (const std::size_t j : robot.yaw_joints()) values.push_back(robot.joints[j].*member);
  return upper_median(values);
}

void judge_joint(const RobotModel& robot, const JointBound& bound, CheckVerdict& verdict) {
  const double found = of_most_joints(robot, bound.member);
  const double amount = bound.sign * found;
  if (amount >= bound.enough) return;
  const bool refused = amount < bound.least;
  const std::string accepted =
      refused ? fmt::format("accepted at {}", bound.sign < 0.0 ? "most" : "least") : "it moves well from";
  (refused ? verdict.refusals : verdict.warnings)
      .push_back(fmt::format("the robot {} {}: joints.{}: found {:g}, {} {:.2g}: {}", robot.name,
                             refused ? "does not move" : "hardly moves", bound.key, found, accepted,
                             bound.sign * (refused ? bound.least : bound.enough), bound.why));
}

/// [rad/s] Largest rate of a yaw joint in the wave of `travel` at the highest frequency that control uses.
double wave_rate_rad_s(const RobotModel& robot, const ControlConfig& config) {
  const double link_m = link_share(robot) * kTunedLink_m;
  const double swing_rad = 2.0 * config.travel.amplitude_rad *
                           std::sin(std::numbers::pi * std::min(0.5, link_m / config.travel.wavelength_m));
  return 2.0 * std::numbers::pi * config.most_hz * swing_rad;
}

/// Warns of a method for a kind of motion without an object with which the robot loses its pose.
void judge_method(const MethodRegistry& methods, const char* kind, const MotionParameters& motion,
                  CheckVerdict& verdict) {
  const auto keeps_pose = [&](const std::string& name) { return methods.find(name)->keeps_pose(); };
  const std::string& chosen = drive_methods().at(motion.method);
  if (keeps_pose(chosen)) return;
  std::vector<std::string> keeping;
  std::copy_if(drive_methods().begin(), drive_methods().end(), std::back_inserter(keeping), keeps_pose);
  verdict.warnings.push_back(
      fmt::format("control: motion.{}.method: found {}, missions succeed with {}: the robot loses its pose with other "
                  "methods",
                  kind, chosen, fmt::join(keeping, " and ")));
}

}  // namespace

CheckVerdict judge_joints(const RobotModel& robot, const ControlConfig& config) {
  CheckVerdict verdict;
  const MethodRegistry methods;
  judge_method(methods, "travel", config.travel, verdict);
  judge_method(methods, "creep", config.creep, verdict);
  if (robot.yaw_joints().empty() || config.travel.method != 0) return verdict;  // measured for undulation
  const double share = link_share(robot);                                       // shorter links bend less
  const double least_rad = share * kLeastRange_rad, enough_rad = share * kEnoughRange_rad;
  constexpr const char* kBothSides = "its wave bends each joint to both sides";
  // The friction of the ground to the side, by which the body pushes itself forwards, grows with the weight.
  constexpr double kTuned_kg_m = 0.3 / 0.089;
  const double weight = robot.module_mass_kg / robot.module_length_m / kTuned_kg_m;
  const double rate_rad_s = wave_rate_rad_s(robot, config) / config.speed_share;
  for (const JointBound& bound :
       {JointBound{"max_rad", &JointModel::max_rad, 1.0, least_rad, enough_rad, kBothSides},
        JointBound{"min_rad", &JointModel::min_rad, -1.0, least_rad, enough_rad, kBothSides},
        JointBound{"max_torque_nm", &JointModel::max_torque_nm, 1.0, weight * kLeastTorque_nm,
                   weight * kEnoughTorque_nm, "weaker joints do not push a body of this mass over the ground"},
        JointBound{"position_gain_nm_rad", &JointModel::position_gain_nm_rad, 1.0, weight * kLeastGain_nm_rad,
                   weight * kEnoughGain_nm_rad, "softer servos do not hold the wave against the ground"},
        JointBound{"max_speed_rad_s", &JointModel::max_speed_rad_s, 1.0, kLeastRate * rate_rad_s,
                   kEnoughRate * rate_rad_s,
                   "slower joints do not follow its wave, which a smaller wave.most_hz of control makes slower"}})
    judge_joint(robot, bound, verdict);
  if (robot.module_count > kMostModules) {
    verdict.warnings.push_back(
        fmt::format("the robot {}: module.count: found {}, missions succeed with up to {}: all that were tried with 50 "
                    "and more failed",
                    robot.name, robot.module_count, kMostModules));
  }
  return verdict;
}

}  // namespace constrictor
