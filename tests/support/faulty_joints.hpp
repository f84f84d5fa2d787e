// Joints that exist only as numbers, and a driver of them that can have any of the faults that drivers have. It knows
// neither DDS nor a clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "conform/plant_port.hpp"

namespace constrictor::testing {

class FaultyJoints {
 public:
  static constexpr double kLimit_rad = 1.5, kSpeed_rad_s = 4.0, kFriction_nm = 1.2, kGain_nm_rad = 300.0;
  static constexpr double kSilence_s = 0.1;

  FaultyJoints(std::size_t count, std::string fault) : fault_(std::move(fault)), position_(count) {
    goal_ = velocity_ = torque_ = feed_ = limit_ = friction_ = push_ = position_;
  }

  /// A command as it arrived. `session`, `number`: as its writer says.
  void take(const conform::PlantCommand& command, std::uint64_t session, std::uint64_t number, double now_s) {
    const bool silent = now_s - heard_s_ > kSilence_s;
    const bool stranger = session_ != 0 && session != session_;
    if (stranger && has("loses_session")) return;
    if (stranger && !silent && !has("obeys_stranger")) return;
    if (!stranger && number <= number_ && !has("obeys_old")) return;
    if (stopped && !has("ignores_stop")) return;
    const std::size_t count = position_.size();
    const bool sized = command.position_rad.size() == count;
    if (!sized && !has(command.position_rad.size() < count ? "obeys_short" : "obeys_long")) return;
    if (command.unknown_mode && !has("obeys_mode")) return;
    for (std::size_t i = 0; i < std::min(count, command.position_rad.size()); ++i) {
      if (!std::isfinite(command.position_rad[i]) && !has("obeys_nan")) return;
      if (std::abs(command.position_rad[i]) > kLimit_rad + 1e-6 && !has("ignores_limit")) return;
    }
    if (!stranger || silent) number_ = number;
    session_ = has("obeys_stranger") && stranger && !silent ? session_ : session;
    heard_s_ = now_s;
    if (command.torque && has("no_torque_mode")) return;
    relaxed_ = command.relaxed;
    pushed_ = command.torque;
    for (std::size_t i = 0; i < std::min(count, command.position_rad.size()); ++i) {
      if (!std::isfinite(command.position_rad[i])) continue;
      goal_[i] = command.position_rad[i] * (has("degrees_in") ? M_PI / 180.0 : 1.0);
      feed_[i] = command.velocity_rad_s[i];
      limit_[i] = command.torque_limit_nm[i];
      const double bound = has("torque_unbound") ? 100.0 : limit_[i];
      push_[i] = std::clamp(command.torque_nm[i], -bound, bound) * (has("push_sign") && i == 6 ? -1.0 : 1.0);
    }
    if (has("push_swapped")) std::swap(push_[3], push_[5]);
  }

  void move(double now_s, double passed_s) {
    holding_ = session_ == 0 || now_s - heard_s_ > kSilence_s;
    if (holding_ && !was_holding_ && !(pushed_ && has("pushes_on"))) {
      goal_ = position_;
      pushed_ = false;
    }
    was_holding_ = holding_;
    for (std::size_t i = 0; i < position_.size(); ++i) {
      if (holding_ && has("ignores_silence")) goal_[i] += feed_[i] * passed_s;
      const double limit = relaxed_ ? 0.0 : has("ignores_torque") ? 100.0 : limit_[i];
      const double error = goal_[i] - position_[i];
      const double largest = limit > kFriction_nm ? kSpeed_rad_s * passed_s : 0.0;
      if (pushed_) {
        push(i, passed_s);
        continue;
      }
      const bool loose = (has("dead") && i == 4) || (has("drifts") && i == 7);
      const double step = loose ? 0.0 : std::clamp(error, -largest, largest);
      position_[i] += step + (has("drifts") && i == 7 ? 0.05 * passed_s : 0.0);
      velocity_[i] = step / passed_s;
      // Friction that was overcome stays as a load, as in real gears.
      if (std::abs(step) > 1e-9) friction_[i] = std::copysign(kFriction_nm, step);
      const double load = std::abs(error - step) > 1e-9 ? kGain_nm_rad * (error - step) : friction_[i];
      torque_[i] = std::clamp(load, -limit, limit);
    }
    if (relaxed_ && has("keeps_torque")) std::fill(torque_.begin(), torque_.end(), 0.8);
    past_.push_back(position_);
    if (past_.size() > 41) past_.pop_front();
  }

  /// What the driver writes. False: nothing this time.
  bool measure(double now_s, conform::JointSample& sample) {
    ++calls_;
    if (never_returns_ || has("silent") || (has("slow") && calls_ % 10 != 0)) return false;
    if (has("ends_with_commands") && holding_ && session_ != 0) return false;
    sample = {};
    sample.session = has("session_0") ? 0 : own_session;
    sample.number = has("same_number") ? 7 : ++written_;
    sample.time_ns = std::llround(now_s * (has("stamp_in_ms") ? 1e3 : 1e9));
    if (has("same_stamp")) sample.time_ns = 5;
    sample.confirmed_session = has("confirms_nothing") ? 0 : session_;
    sample.confirmed_number = has("confirms_nothing") ? 0 : number_;
    sample.holding = holding_ && !has("hides_holding");
    if (has("reports_fault")) sample.fault = "bus power is low";
    sample.position_rad = has("late") ? past_.front() : position_;
    sample.velocity_rad_s = velocity_;
    sample.torque_nm = torque_;
    auto& angles = sample.position_rad;
    if (has("frozen")) std::fill(angles.begin(), angles.end(), 0.0);
    if (has("sign")) {
      angles[3] = -angles[3];
      sample.velocity_rad_s[3] = -velocity_[3];
    }
    if (has("swapped")) std::swap(angles[3], angles[5]);
    if (has("gain")) angles[6] *= 1.5;
    if (has("zero_off")) angles[2] += 2.0;
    if (has("velocity_in_degrees"))
      for (double& rate : sample.velocity_rad_s) rate *= 180.0 / M_PI;
    if (has("torque_sign"))
      for (double& torque : sample.torque_nm) torque = -torque;
    if (has("torque_direction"))  // every second servo is mounted the other way, and its current is not turned round
      for (std::size_t i = 1; i < sample.torque_nm.size(); i += 2) sample.torque_nm[i] = -sample.torque_nm[i];
    if (has("degrees_out"))
      for (double& angle : angles) angle *= 180.0 / M_PI;
    if (has("nan")) angles[9] = std::numeric_limits<double>::quiet_NaN();
    if (has("wrong_count")) {
      angles.pop_back();
      sample.velocity_rad_s.pop_back();
      sample.torque_nm.pop_back();
    }
    return true;
  }

  [[nodiscard]] bool has(const char* fault) const { return fault_ == fault; }
  /// The process ends and starts again; the joints stay where they are.
  void restart() {
    if (has("never_returns")) never_returns_ = true;
    if (!has("keeps_session")) ++own_session;
    forget_session();
    goal_ = position_;
    relaxed_ = pushed_ = false;
    holding_ = was_holding_ = true;
    if (has("jumps_after_restart")) std::fill(goal_.begin(), goal_.end(), 0.0);
    for (std::size_t i = 0; i < goal_.size(); ++i)
      if (has("finishes_after_restart") && feed_[i] != 0.0) goal_[i] += std::copysign(0.1, feed_[i]);
  }
  void forget_session() { session_ = number_ = written_ = 0; }
  bool stopped = false;
  std::uint64_t own_session = 4711;

 private:
  /// A joint without inertia: what is left of its torque after dry friction turns it against viscous friction.
  void push(std::size_t i, double passed_s) {
    const double left_nm = std::max(0.0, std::abs(push_[i]) - kFriction_nm);
    const double rate = std::clamp(std::copysign(left_nm, push_[i]) / kViscous_nm_s_rad, -kSpeed_rad_s, kSpeed_rad_s);
    position_[i] = std::clamp(position_[i] + rate * passed_s, -kLimit_rad, kLimit_rad);
    velocity_[i] = rate;
    torque_[i] = push_[i];
    goal_[i] = position_[i];
  }

  static constexpr double kViscous_nm_s_rad = 1.0;
  std::string fault_;
  std::vector<double> position_, goal_, velocity_, torque_, feed_, limit_, friction_, push_;
  std::deque<std::vector<double>> past_;
  std::uint64_t session_ = 0, number_ = 0, written_ = 0, calls_ = 0;
  double heard_s_ = -1.0;
  bool holding_ = true, was_holding_ = true, relaxed_ = false, pushed_ = false, never_returns_ = false;
};

}  // namespace constrictor::testing
