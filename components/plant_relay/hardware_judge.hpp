// Decides which samples of a process outside the barrier can be true. Pure: time is counted in ticks.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "plant_relay/plant_relay_config.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// The last accepted sample of each topic, of the session that is followed. Serialisable.
struct HardwareMemory {
  std::uint64_t session = 0;  ///< 0: none is followed
  std::uint64_t joint_number = 0, contact_number = 0, imu_number = 0;
  std::int64_t joint_time_ns = 0;
  std::int64_t accepted_tick = -1;  ///< of the last joint state; -1: none since the start
  std::int64_t accepted = 0;        ///< joint states in a row
  std::vector<double> angles_rad;   ///< of the last joint state; empty: the posture is not known
  template <class Archive>
  void serialize(Archive& archive) {
    archive(session, joint_number, contact_number, imu_number, joint_time_ns, accepted_tick, accepted, angles_rad);
  }
};

class HardwareJudge {
 public:
  HardwareJudge(const RobotModel& robot, const PlantRelayConfig& config) : joints_(robot.joints), config_(config) {}

  /// Why the sample that has arrived at `tick` cannot be used, in words for people: what was found, what is accepted
  /// and what to do; empty: it is used, and `memory` contains it. A session is followed until forget(); samples of
  /// another one are refused meanwhile, because two processes must not both drive the joints.
  [[nodiscard]] std::string judge(const msg::HardwareJointState& sample, std::int64_t tick,
                                  HardwareMemory& memory) const;
  [[nodiscard]] std::string judge(const msg::HardwareContactState& sample, HardwareMemory& memory) const;
  [[nodiscard]] std::string judge(const msg::HardwareImuState& sample, HardwareMemory& memory) const;
  /// The posture is no longer known, and any session may be the next one.
  static void forget(HardwareMemory& memory) { memory = {}; }

 private:
  [[nodiscard]] std::string absurd(const msg::HardwareJointState& sample, const HardwareMemory& memory) const;
  std::vector<JointModel> joints_;
  PlantRelayConfig config_;
};

}  // namespace constrictor
