// The expectations of `constrictor conform plant`, and how it moves the joints: one row for each value.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "configuration/configuration.hpp"
#include "configuration/parameter_set.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::conform {

struct PlantProfile : ParameterSet {
  int joint_count = add(joint_count, "joint_count", 0, "", {0, 64}, kAtStart,
                        "Joints of the robot; 0: as many as the robot file has");
  double period_s = add(period_s, "period_s", 0.02, "s", {0.002, 0.2}, kAtStart, "Control period");
  double patience_s =
      add(patience_s, "patience_s", 10.0, "s", {0.5, 600.0}, kAtStart, "Time to wait for the first measured posture");
  std::vector<double> joints =
      add(joints, "joints", {}, "", {0, 63}, ListSize{0, 64}, "Joints that are moved, one after the other; empty: all");
  double amplitude_rad = add(amplitude_rad, "motion.amplitude_rad", 0.08, "rad", {0.01, 0.5}, kAtStart,
                             "How far each joint is moved; at most three times as far before it is held");
  double rate_rad_s = add(rate_rad_s, "motion.rate_rad_s", 0.4, "rad/s", {0.02, 3.0}, kAtStart, "How fast");
  double settle_s =
      add(settle_s, "motion.settle_s", 0.3, "s", {0.1, 10.0}, kAtStart, "Time that a joint needs to come to rest");
  double torque_share = add(torque_share, "motion.torque_share", 1.0, "", {0.01, 1.0}, kAtStart,
                            "Torque limit while moving, as a share of the robot file's");
  bool torque_mode = add(torque_mode, "torque.mode", true,
                         "The plant exerts torques on command (kServoTorque); false: this is not checked");
  double push_nm = add(push_nm, "torque.push_nm", 2.0, "Nm", {0.05, 100.0}, kAtStart,
                       "Largest torque that pushes a joint; it rises within a second, until the joint turns");
  double gain_tolerance = add(gain_tolerance, "tolerance.gain", 0.35, "", {0.01, 0.9}, kAtStart,
                              "A joint may move further or less far by this share of the motion");
  double rest_rad = add(rest_rad, "tolerance.rest_rad", 0.02, "rad", {0.0001, 0.2}, kAtStart,
                        "A joint at rest moves by less than this");
  double delay_s = add(delay_s, "tolerance.delay_s", 0.2, "s", {0.01, 5.0}, kAtStart,
                       "A joint follows its setpoint by no more than this later");
  double velocity_share = add(velocity_share, "tolerance.velocity", 0.5, "", {0.05, 0.95}, kAtStart,
                              "The median of the joints' rates may differ from that of the angles by this share");
  double torque_nm = add(torque_nm, "tolerance.torque_nm", 0.5, "Nm", {0.01, 100.0}, kAtStart,
                         "A torque may exceed its limit by this");
  double felt_nm = add(felt_nm, "tolerance.felt_nm", 0.05, "Nm", {0.0, 10.0}, kAtStart,
                       "A mean load smaller than this does not show the torque's sign");
  double against_nm = add(against_nm, "tolerance.against_nm", 0.2, "Nm", {0.0, 10.0}, kAtStart,
                          "The load of a moved joint points against its way by less than this");
  double gravity_m_s2 = add(gravity_m_s2, "tolerance.gravity_m_s2", 1.5, "m/s2", {0.1, 5.0}, kAtStart,
                            "The acceleration at rest differs from 9.81 m/s2 upwards by less than this");
  double rate_share = add(rate_share, "rate.least", 0.85, "", {0.1, 1.0}, kAtStart,
                          "Least number of samples, as a share of one in each control period");
  double longest_gap_s =
      add(longest_gap_s, "rate.longest_gap_s", 0.1, "s", {0.01, 5.0}, kAtStart, "Longest time between two samples");
  double stop_within_s = add(stop_within_s, "stop_within_s", 0.4, "s", {0.05, 5.0}, kAtStart,
                             "Time after which a joint rests when commands end or a stop is ordered");

  double restart_within_s = add(restart_within_s, "restart_within_s", 30.0, "s", {1.0, 600.0}, kAtStart,
                                "Time within which the plant is back after its process was ended");

  /// Fills in what follows from the robot. Throws ConfigurationError if both do not agree.
  void adapt_to(const RobotModel& robot) {
    if (joint_count == 0) joint_count = static_cast<int>(robot.joints.size());
    if (joint_count != static_cast<int>(robot.joints.size()))
      throw ConfigurationError("profile: joint_count: found " + std::to_string(joint_count) + ", accepted " +
                               std::to_string(robot.joints.size()) + ", as the robot file says (--robot)");
    if (joints.empty()) {
      for (int i = 0; i < joint_count; ++i) joints.push_back(i);
    }
    for (const double joint : joints) {
      if (joint >= joint_count || joint != static_cast<int>(joint))
        throw ConfigurationError("profile: joints: found " + std::to_string(joint) + ", accepted whole numbers below " +
                                 std::to_string(joint_count));
    }
  }
};

}  // namespace constrictor::conform
