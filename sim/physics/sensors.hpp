// The robot's own sensors in the simulated world, with the noise of the robot file, and the ground truth that only the simulation
// publishes.
#pragma once

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "sim/scenario/random.hpp"
#include "sim/world/world.hpp"

namespace constrictor {

/// Each sensor draws from a stream of its own. Rates of joints carry no noise of their own.
class Sensors {
 public:
  /// `seed` of the epoch and component; with `noise` false every reading is exact.
  Sensors(const RobotModel& robot, std::uint64_t seed, bool noise);

  [[nodiscard]] msg::JointState joints(const World& world);
  /// ContactState and TouchedState in the same order. Contacts beyond the messages' room are left out, the weakest first.
  void contacts(const World& world, msg::ContactState& felt, msg::TouchedState& touched);
  /// `elapsed_s` since the previous reading: the yaw's drift grows with its root. Yaw counts from the first reading.
  [[nodiscard]] msg::ImuState imu(const World& world, double elapsed_s);

 private:
  [[nodiscard]] Eigen::Vector3d noisy(const Eigen::Vector3d& value, double sd, Random& random) const;

  RobotModel robot_;
  bool noise_;
  Random joint_random_;
  Random contact_random_;
  Random imu_random_;
  bool started_ = false;
  double start_yaw_rad_ = 0.0;
  double yaw_drift_rad_ = 0.0;
};

[[nodiscard]] msg::WorldState world_message(const World& world);

}  // namespace constrictor
