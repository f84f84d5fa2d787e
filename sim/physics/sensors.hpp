// The robot's sensors in the simulated world, with the noise of the robot file, and the ground truth that only the
// simulation publishes.
#pragma once

#include "component/random.hpp"
#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "sim/world/world.hpp"

namespace constrictor {

/// Each sensor has its own random stream. Measured joint rates have no noise.
class Sensors {
 public:
  /// `seed` is Setup::component_seed(). If `noise` is false, every reading is exact.
  Sensors(const RobotModel& robot, std::uint64_t seed, bool noise);

  [[nodiscard]] msg::JointState joints(const World& world);
  /// Fills ContactState and TouchedState in the same order. If there are more contacts than a message can hold, the
  /// weakest ones are left out.
  void contacts(const World& world, msg::ContactState& felt, msg::TouchedState& touched);
  /// `elapsed_s` is the time since the previous reading: the yaw drifts by a random step that is proportional to its
  /// square root. The yaw is relative to the first reading.
  [[nodiscard]] msg::ImuState imu(const World& world, double elapsed_s);

  /// The memory of the sensors: random streams, and the drift of the yaw.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(joint_random_, contact_random_, imu_random_, started_, start_yaw_rad_, yaw_drift_rad_);
  }

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

[[nodiscard]] msg::WorldState world_state(const World& world);

}  // namespace constrictor
