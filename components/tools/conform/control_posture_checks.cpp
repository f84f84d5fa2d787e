// Postures: do the right joints bend, in the right direction, as far and as fast as demanded?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "configuration/counted.hpp"

#include "conform/control_conformance.hpp"
#include "conform/unit_factor.hpp"

namespace constrictor::conform {
namespace {

constexpr double kBendRate_rad_s = 1.0;

double rms(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

std::vector<double> ControlConformance::yaw_angles(const msg::JointCommand& command) const {
  std::vector<double> angles;
  for (const std::size_t joint : yaw_) angles.push_back(command.position_rad[joint]);
  return angles;
}

ControlConformance::Steps ControlConformance::bend(const std::vector<double>& shape_rad, double rate_rad_s) {
  auto& desired = hand_.begin("bend");
  desired.shape_count = static_cast<std::uint16_t>(shape_rad.size());
  std::copy(shape_rad.begin(), shape_rad.end(), desired.shape_rad);
  desired.shape_rate_rad_s = rate_rad_s;
  double most_rad = 0.0;
  for (std::size_t k = 0; k < shape_rad.size(); ++k)
    most_rad = std::max(most_rad, std::abs(shape_rad[k] - hand_.measured_rad()[yaw_[k]]));
  return go(2.0 + 1.5 * std::min(most_rad, 4.0) / std::min(rate_rad_s, 1.0));
}

void ControlConformance::check_bend() {
  const std::size_t count = yaw_.size();
  const Steps first = bend(std::vector<double>(count, 0.0), kBendRate_rad_s);
  std::optional<std::int64_t> echo_ticks;
  for (std::size_t i = 0; i < first.size() && !echo_ticks; ++i) {
    for (const auto& state : first[i].states) {
      if (state.motion_id == hand_.desired->motion_id && !text_of(state.method).empty())
        echo_ticks = static_cast<std::int64_t>(i);
    }
  }
  const msg::MotionStatus* state = last_state(first);
  const bool late = !echo_ticks || kTick_s * static_cast<double>(*echo_ticks) > profile_.answer_s;
  report_.judge("echo", late,
                echo_ticks ? "after " + counted(*echo_ticks, "tick")
                : state ? fmt::format("motion {} with the method '{}', not motion {} with its method", state->motion_id,
                                      printable(text_of(state->method)), hand_.desired->motion_id)
                        : "no motion_status",
                "copy motion_id, and name the method that moves the robot");
  bends_ = state != nullptr && state->accepted;
  report_.judge("bend", !bends_, bends_ ? "accepted" : "not accepted",
                "offer this motion: navigation uses it to take and to leave each posture");
  if (!bends_) {
    for (const char* name : {"order", "sign", "unit", "gain", "shape_rate", "done"})
      report_.skip(name, "the motion bend is not accepted");
    return;
  }
  std::vector<double> shape_rad;  // no two joints are alike, and no joint is like another with the wrong sign
  for (std::size_t k = 0; k < count; ++k)
    shape_rad.push_back((k % 3 == 1 ? -1.0 : 1.0) * (0.15 + 0.6 * static_cast<double>(k) / static_cast<double>(count)));
  const Steps steps = bend(shape_rad, kBendRate_rad_s);
  judge_posture(shape_rad, yaw_angles(*last_command(steps)));
  judge_course(steps, shape_rad);
}

void ControlConformance::judge_posture(const std::vector<double>& shape_rad, const std::vector<double>& reached_rad) {
  const double close_rad = profile_.posture_rad;
  std::string order, sign, gain;
  for (std::size_t k = 0; k < shape_rad.size(); ++k) {
    const double error_rad = std::abs(reached_rad[k] - shape_rad[k]);
    if (error_rad <= close_rad) continue;
    if (std::abs(reached_rad[k] + shape_rad[k]) <= close_rad) {
      if (sign.empty()) sign = fmt::format("yaw joint {} is bent the other way", k);
      continue;
    }
    for (std::size_t other = 0; other < shape_rad.size() && order.empty(); ++other) {
      if (other != k && std::abs(reached_rad[k] - shape_rad[other]) <= 0.5 * close_rad)
        order = fmt::format("yaw joint {} has the angle of yaw joint {}", k, other);
    }
    if (gain.empty()) gain = fmt::format("yaw joint {} at {:.2f} rad, not {:.2f}", k, reached_rad[k], shape_rad[k]);
  }
  const double ratio = rms(reached_rad) / rms(shape_rad);
  const bool unit = ratio > kUnitFactor || ratio < 1.0 / kUnitFactor;
  if (unit) order.clear();  // angles near 0 resemble each other
  report_.pass_unless("order", order, "each joint by itself",
                      "count the yaw joints from the head, pitch joints not included");
  report_.pass_unless("sign", sign, "positive is left", "invert the direction of these joints");
  report_.judge("unit", unit, fmt::format("{:.2f} times the demanded angles", ratio), "write angles in radians");
  const bool wrong = !gain.empty() && order.empty() && !unit;
  report_.judge("gain", wrong, wrong ? gain : fmt::format("{:.2f} times the demanded angles", ratio),
                "go on until each yaw joint has its angle of shape_rad");
}

void ControlConformance::judge_course(const Steps& steps, const std::vector<double>& shape_rad) {
  double fastest_rad_s = 0.0;
  double progress = 0.0, fallen = 0.0;
  std::string wrong;
  const std::vector<double>* before = nullptr;
  std::vector<double> now, last;
  for (const auto& step : steps) {
    if (step.commands.empty() || step.states.empty()) continue;
    now = yaw_angles(step.commands.back());
    double left_rad = 0.0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (before) fastest_rad_s = std::max(fastest_rad_s, std::abs(now[k] - last[k]) / kTick_s);
      left_rad = std::max(left_rad, std::abs(now[k] - shape_rad[k]));
    }
    last = now;
    before = &last;
    const msg::MotionStatus& state = step.states.back();
    if (state.motion_id != hand_.desired->motion_id) continue;
    if (state.done && left_rad > 0.1 && wrong.empty())
      wrong = fmt::format("done is set with {:.2f} rad to go", left_rad);
    fallen = std::max(fallen, progress - state.progress);
    progress = state.progress;
  }
  const msg::MotionStatus* state = last_state(steps);
  if (wrong.empty() && !state->done) wrong = fmt::format("done is never set, progress {:.2f}", state->progress);
  if (wrong.empty() && (fallen > 0.01 || progress < 0.99))
    wrong = fmt::format("progress falls by {:.2f} and ends at {:.2f}", fallen, progress);
  report_.judge("shape_rate", fastest_rad_s > kBendRate_rad_s * (1.0 + profile_.gain_tolerance),
                fmt::format("{:.2f} rad/s, with {:.2f} rad/s demanded", fastest_rad_s, kBendRate_rad_s),
                "limit the speed of each joint to shape_rate_rad_s");
  report_.pass_unless("done", wrong, "set at the end",
                      "compare the setpoints with shape_rad; navigation waits for done");
}

void ControlConformance::check_squeeze() {
  constexpr double kSqueeze_rad = 0.3, kLimit_nm = 2.0, kBase_rad = 1.0;
  if (!bends_ || yaw_.size() < 7) return report_.skip("squeeze", "needs the method bend, and seven yaw joints");
  const std::size_t middle = yaw_.size() / 2;
  std::vector<double> shape_rad(yaw_.size(), 0.0);
  for (std::size_t k = middle - 1; k <= middle + 1; ++k) shape_rad[k] = kBase_rad;
  bend(shape_rad, kBendRate_rad_s);
  auto& desired = hand_.begin("squeeze");
  desired.shape_count = static_cast<std::uint16_t>(shape_rad.size());
  std::copy(shape_rad.begin(), shape_rad.end(), desired.shape_rad);
  desired.wrap_side = 1.0;
  desired.squeeze_rad = kSqueeze_rad;
  desired.shape_rate_rad_s = 0.3;
  desired.torque_limit_nm = kLimit_nm;
  const Steps steps = go(4.0);
  const msg::MotionStatus* state = last_state(steps);
  if (state == nullptr || !state->accepted) {
    report_.skip("squeeze", "the method squeeze is not accepted: this control cannot grasp");
  } else {
    const msg::JointCommand& end = *last_command(steps);
    double closed_rad = -3.0 * kBase_rad, torque_nm = 0.0;
    for (std::size_t k = middle - 1; k <= middle + 1; ++k) {
      closed_rad += end.position_rad[yaw_[k]];
      torque_nm = std::max(torque_nm, end.torque_limit_nm[yaw_[k]]);
    }
    const bool wrong_way = std::abs(closed_rad / kSqueeze_rad - 1.0) > profile_.gain_tolerance;
    report_.judge("squeeze", wrong_way || torque_nm > kLimit_nm + 0.01 || !state->done,
                  fmt::format("closed by {:.2f} rad with up to {:.1f} Nm, {}done", closed_rad, torque_nm,
                              state->done ? "" : "not "),
                  fmt::format("close by {} rad with {} Nm at most, then set done", kSqueeze_rad, kLimit_nm));
  }
  bend(std::vector<double>(yaw_.size(), 0.0), kBendRate_rad_s);
}

void ControlConformance::check_limits() {
  if (bends_) {
    std::vector<double> far_rad(yaw_.size());
    for (std::size_t k = 0; k < far_rad.size(); ++k) far_rad[k] = k % 2 == 0 ? 3.0 : -3.0;
    bend(far_rad, 4.0);
    bend(std::vector<double>(yaw_.size(), 0.0), 4.0);
  }
  report_.judge("position_limit", beyond_rad_ > 1e-6,
                fmt::format("{:.3f} rad beyond at most", std::max(0.0, beyond_rad_)),
                "clamp each setpoint to the limits of the robot file, at the last place before it is written");
  report_.judge("rate_limit", largest_rate_ > 1.02,
                fmt::format("{:.2f} times the largest speed of joint {} at most", largest_rate_, fastest_),
                "limit the change of each setpoint from one tick to the next");
  report_.judge("torque_limit", beyond_nm_ > 1e-6, fmt::format("{:.2f} Nm beyond at most", std::max(0.0, beyond_nm_)),
                "limit torque_limit_nm to max_torque_nm of the robot file");
  const double share = compared_ == 0 ? 0.0 : static_cast<double>(unlike_) / static_cast<double>(compared_);
  if (compared_ == 0) report_.skip("velocity", "velocity_rad_s is always 0");
  else
    report_.judge("velocity", share > 0.1,
                  fmt::format("{:.0f} % of {} rates are not those of the setpoints", 100.0 * share, compared_),
                  "write the change of the setpoint by the control period, in rad/s");
}

}  // namespace constrictor::conform
