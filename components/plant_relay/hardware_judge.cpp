#include "plant_relay/hardware_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

constexpr double kMostTorque_nm = 1000.0;
constexpr double kQuaternionTolerance = 0.01;

/// Session and number, which are checked alike on all topics. `last`: number of the last accepted sample.
template <class Sample>
std::string out_of_order(const char* topic, const Sample& sample, const HardwareMemory& memory, std::uint64_t last) {
  if (sample.session == 0)
    return fmt::format("{}.session: found 0, accepted a random number that the process draws when it starts", topic);
  if (memory.session != 0 && sample.session != memory.session)
    return fmt::format(
        "{}.session: found {:x} beside {:x}: two processes write, end one of them (a process that was started again is "
        "accepted when the samples of its predecessor have ended)",
        topic, sample.session, memory.session);
  if (sample.sequence_number <= last)
    return fmt::format("{}.sequence_number: found {} after {}, accepted one more with each sample", topic,
                       sample.sequence_number, last);
  return {};
}

}  // namespace

std::string HardwareJudge::absurd(const msg::HardwareJointState& sample, const HardwareMemory& memory) const {
  const double passed_s = static_cast<double>(sample.time_ns - memory.joint_time_ns) * 1e-9;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double angle_rad = sample.position_rad[i];
    const double beyond_rad = std::max(angle_rad - joints_[i].max_rad, joints_[i].min_rad - angle_rad);
    if (beyond_rad > config_.limit_tolerance_rad)
      return fmt::format(
          "hardware/joint_state.position_rad[{}]: found {:.3f}, accepted {:.3f} to {:.3f} rad: unit, zero or sign of "
          "the joint is wrong",
          i, angle_rad, joints_[i].min_rad - config_.limit_tolerance_rad,
          joints_[i].max_rad + config_.limit_tolerance_rad);
    if (std::abs(sample.torque_nm[i]) > kMostTorque_nm)
      return fmt::format(
          "hardware/joint_state.torque_nm[{}]: found {:.0f}, accepted {:.0f} Nm at most: the unit is "
          "wrong",
          i, sample.torque_nm[i], kMostTorque_nm);
    if (memory.angles_rad.empty()) continue;
    const double step_rad = std::abs(angle_rad - memory.angles_rad[i]);
    const double most_rad = joints_[i].max_speed_rad_s * passed_s + config_.jump_tolerance_rad;
    if (step_rad > most_rad)
      return fmt::format(
          "hardware/joint_state.position_rad[{}]: found a jump by {:.3f} rad in {:.3f} s, accepted "
          "{:.3f} rad at most: the joint cannot be so fast",
          i, step_rad, passed_s, most_rad);
  }
  return {};
}

std::string HardwareJudge::judge(const msg::HardwareJointState& sample, std::int64_t tick,
                                 HardwareMemory& memory) const {
  const char* topic = "hardware/joint_state";
  if (std::string why = out_of_order(topic, sample, memory, memory.joint_number); !why.empty()) return why;
  if (memory.session != 0 && memory.joint_number != 0 && sample.time_ns <= memory.joint_time_ns)
    return fmt::format("{}.time_ns: found {} after {}, accepted the instant of each measurement, rising", topic,
                       sample.time_ns, memory.joint_time_ns);
  if (sample.joint_count != joints_.size())
    return fmt::format("{}.joint_count: found {}, accepted {}, as the robot file says", topic, sample.joint_count,
                       joints_.size());
  if (std::string why = absurd(sample, memory); !why.empty()) return why;
  memory.session = sample.session;
  memory.joint_number = sample.sequence_number;
  memory.joint_time_ns = sample.time_ns;
  memory.accepted_tick = tick;
  ++memory.accepted;
  memory.angles_rad.assign(sample.position_rad, sample.position_rad + joints_.size());
  return {};
}

std::string HardwareJudge::judge(const msg::HardwareContactState& sample, HardwareMemory& memory) const {
  const char* topic = "hardware/contact_state";
  if (std::string why = out_of_order(topic, sample, memory, memory.contact_number); !why.empty()) return why;
  const std::size_t modules = joints_.size() + 1;
  if (sample.module_count != 0 && sample.module_count != modules)
    return fmt::format("{}.module_count: found {}, accepted {}, as the robot file says, or 0: no sensors", topic,
                       sample.module_count, modules);
  memory.contact_number = sample.sequence_number;
  return {};
}

std::string HardwareJudge::judge(const msg::HardwareImuState& sample, HardwareMemory& memory) const {
  const char* topic = "hardware/imu_state";
  if (std::string why = out_of_order(topic, sample, memory, memory.imu_number); !why.empty()) return why;
  const auto& q = sample.orientation;
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (std::abs(norm - 1.0) > kQuaternionTolerance)
    return fmt::format("{}.orientation: found a quaternion of length {:.3f}, accepted 1", topic, norm);
  memory.imu_number = sample.sequence_number;
  return {};
}

}  // namespace constrictor
