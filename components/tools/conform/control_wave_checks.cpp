// Moving along a path: period and direction of the travelling wave, speed, curvature of the path.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "configuration/quantiles.hpp"
#include "conform/control_conformance.hpp"
#include "robot/planar.hpp"
#include "robot/trajectory_path.hpp"

namespace constrictor::conform {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPeriods = 2;  // of the wave, over which it is measured

/// mean + amplitude cos(2 pi f t + phase), fitted to the setpoints of a joint.
struct Fit {
  double mean_rad = 0.0, amplitude_rad = 0.0, phase_rad = 0.0;
  double explained = 0.0;  ///< share of the variance
  double seen_hz = 0.0;    ///< half of the passes through the mean, per second
};

Fit fitted(const std::vector<ControlStep>& steps, std::size_t joint, double frequency_hz) {
  std::vector<double> angles;
  for (const auto& step : steps) {
    if (!step.commands.empty()) angles.push_back(step.commands.back().position_rad[joint]);
  }
  Fit fit;
  if (angles.size() < 2) return fit;
  const double count = static_cast<double>(angles.size());
  for (const double angle : angles) fit.mean_rad += angle / count;
  double a = 0.0, b = 0.0, variance = 0.0;
  int passes = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double swing = angles[i] - fit.mean_rad;
    const double argument = 2.0 * kPi * frequency_hz * kTick_s * static_cast<double>(i);
    a += 2.0 / count * swing * std::cos(argument);
    b += 2.0 / count * swing * std::sin(argument);
    variance += swing * swing / count;
    if (i > 0 && (swing < 0.0) != (angles[i - 1] < fit.mean_rad)) ++passes;
  }
  fit.amplitude_rad = std::hypot(a, b);
  fit.phase_rad = std::atan2(-b, a);
  fit.explained = variance > 1e-12 ? 0.5 * fit.amplitude_rad * fit.amplitude_rad / variance : 0.0;
  fit.seen_hz = 0.5 * passes / (count * kTick_s);
  return fit;
}

}  // namespace

void ControlConformance::travel(double speed_m_s, double curvature_1_m) {
  auto& desired = hand_.begin("travel");
  desired.speed_m_s = speed_m_s;
  set_arc(curvature_1_m, desired);
}

void ControlConformance::check_wave() {
  constexpr const char* kRest[] = {"method", "period", "speed", "forwards", "backwards", "curvature"};
  if (yaw_.size() < 4) {
    report_.skip("travel", "needs four yaw joints");
    for (const char* name : kRest) report_.skip(name, "needs four yaw joints");
    return;
  }
  travel(profile_.speed_m_s, 0.0);
  const Steps settling = go(profile_.settle_s);
  const msg::MotionStatus* state = last_state(settling);
  const double period_s = state ? state->period_s : 0.0;
  constexpr double kLongest_s = 10.0;
  rate_hz_ = 1.0 / (period_s > 0.0 ? std::min(period_s, kLongest_s) : 1.0);
  const Steps steps = go(kPeriods / rate_hz_);
  state = last_state(steps);
  const bool accepted = state != nullptr && state->accepted;
  const double swing_rad = moved_rad(steps, 0.0);
  travels_ = accepted && swing_rad > 0.05;
  report_.judge("travel", !travels_,
                !accepted ? "not accepted" : fmt::format("the setpoints swing by up to {:.2f} rad", swing_rad),
                "offer this motion: navigation moves the robot by it");
  if (!travels_) {
    for (const char* name : kRest) report_.skip(name, "the robot does not move");
    return;
  }
  const std::string method = printable(text_of(state->method));
  report_.judge("method", method.empty(), method.empty() ? "no name" : fmt::format("'{}'", method),
                "write the name of the method that moves the robot into motion_status");
  judge_wave(steps);
  judge_speed(steps);
  check_curvature();
}

void ControlConformance::judge_wave(const Steps& steps) {
  /// [rad] median phase of a joint minus that of the joint in front of it.
  const auto lag_rad = [&](const Steps& some) {
    std::vector<double> lags;
    for (std::size_t k = yaw_.size() / 3; k + 1 < yaw_.size(); ++k) {
      const double lag = fitted(some, yaw_[k + 1], rate_hz_).phase_rad - fitted(some, yaw_[k], rate_hz_).phase_rad;
      lags.push_back(wrap_angle(lag));
    }
    return upper_median(lags);
  };
  const Fit middle = fitted(steps, yaw_[yaw_.size() / 2], rate_hz_);
  report_.judge("period", middle.explained < 0.8,
                fmt::format("{:.2f} Hz, with {:.2f} Hz stated", middle.seen_hz, rate_hz_),
                "period_s is the time in which the wave passes a joint once, at the desired speed");
  const double forwards_rad = lag_rad(steps);
  const auto direction = [](double lag) { return lag > 0.0 ? "head" : "tail"; };
  report_.judge("forwards", forwards_rad > 0.0, fmt::format("the wave travels to the {}", direction(forwards_rad)),
                "a wave that travels to the tail pushes the robot forwards");
  travel(-profile_.speed_m_s, 0.0);
  go(profile_.settle_s);
  const double backwards_rad = lag_rad(go(kPeriods / rate_hz_));
  report_.judge("backwards", backwards_rad < 0.0, fmt::format("the wave travels to the {}", direction(backwards_rad)),
                "turn the wave round when speed_m_s is negative");
}

void ControlConformance::judge_speed(const Steps& steps) {
  /// [rad/s] mean absolute rate of the yaw joints' setpoints.
  const auto rate_rad_s = [&](const Steps& some) {
    double sum = 0.0;
    std::size_t count = 0;
    const msg::JointCommand* before = nullptr;
    for (const auto& step : some) {
      if (step.commands.empty()) continue;
      const msg::JointCommand& now = step.commands.back();
      for (const std::size_t joint : yaw_) {
        if (!before) continue;
        sum += std::abs(now.position_rad[joint] - before->position_rad[joint]) / kTick_s;
        ++count;
      }
      before = &now;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  };
  const double whole = rate_rad_s(steps);
  travel(0.5 * profile_.speed_m_s, 0.0);
  go(profile_.settle_s);
  const double half = rate_rad_s(go(2.0 * kPeriods / rate_hz_));
  report_.judge("speed", half > 0.9 * whole,
                fmt::format("{:.2f} rad/s on average, and {:.2f} rad/s at half the speed", whole, half),
                "turn speed_m_s into the frequency or the amplitude of the wave");
}

void ControlConformance::check_curvature() {
  const auto bend_1_m = [&](double curvature_1_m) {
    travel(profile_.speed_m_s, curvature_1_m);
    go(profile_.settle_s);
    const Steps steps = go(kPeriods / rate_hz_);
    double sum_rad = 0.0;
    for (std::size_t k = 1; k < yaw_.size(); ++k) sum_rad += fitted(steps, yaw_[k], rate_hz_).mean_rad;
    const double length_m = robot_.module_length_m * static_cast<double>(yaw_.back() - yaw_.front());
    return sum_rad / length_m;
  };
  const double left = bend_1_m(profile_.curvature_1_m), right = bend_1_m(-profile_.curvature_1_m);
  const double ratio = 0.5 * (left - right) / profile_.curvature_1_m;
  const bool lopsided = std::abs(left + right) > profile_.gain_tolerance * profile_.curvature_1_m;
  report_.judge("curvature", std::abs(ratio - 1.0) > profile_.gain_tolerance || lopsided,
                ratio < -0.2 ? std::string("the body bends the other way")
                             : fmt::format("{:.2f} and {:.2f} 1/m, with +-{:.2f} 1/m demanded", left, right,
                                           profile_.curvature_1_m),
                "bend the body by the curvature of the path; positive is left");
}

void ControlConformance::check_stand() {
  hand_.begin("stand");
  const Steps held = go(1.5);
  const msg::MotionStatus* state = last_state(held);
  const double moved = moved_rad(held, 0.5);
  report_.judge("stand", moved > profile_.posture_rad || state == nullptr || !state->accepted,
                state && state->accepted ? fmt::format("{:.3f} rad after half a second", moved) : "not accepted",
                "keep the posture in which the motion began");
}

}  // namespace constrictor::conform
