// Undulation: frequency, amplitude, direction of the travelling wave, curvature of the path.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "conform/control_conformance.hpp"
#include "conform/median.hpp"

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
    const double argument = 2.0 * kPi * frequency_hz * ControlHand::kPeriod_s * static_cast<double>(i);
    a += 2.0 / count * swing * std::cos(argument);
    b += 2.0 / count * swing * std::sin(argument);
    variance += swing * swing / count;
    if (i > 0 && (swing < 0.0) != (angles[i - 1] < fit.mean_rad)) ++passes;
  }
  fit.amplitude_rad = std::hypot(a, b);
  fit.phase_rad = std::atan2(-b, a);
  fit.explained = variance > 1e-12 ? 0.5 * fit.amplitude_rad * fit.amplitude_rad / variance : 0.0;
  fit.seen_hz = 0.5 * passes / (count * ControlHand::kPeriod_s);
  return fit;
}

}  // namespace

void ControlConformance::undulate(double frequency_hz, double curvature_1_m) {
  auto& desired = hand_.begin("undulation");
  desired.frequency_hz = frequency_hz;
  desired.amplitude_rad = profile_.amplitude_rad;
  desired.wavelength_m = profile_.wavelength_m;
  desired.curvature_1_m = curvature_1_m;
}

void ControlConformance::check_wave() {
  if (yaw_.size() < 4) {
    for (const char* name : {"undulation", "frequency", "amplitude", "forwards", "backwards", "curvature"})
      report_.skip(name, "needs four yaw joints");
    return;
  }
  undulate(profile_.rate_hz, 0.0);
  go(profile_.settle_s);
  const Steps steps = go(kPeriods / profile_.rate_hz);
  const msg::MotionStatus* state = last_state(steps);
  const bool accepted = state != nullptr && state->accepted;
  const double swing_rad = moved_rad(steps, 0.0);
  undulates_ = accepted && swing_rad > 0.05;
  report_.judge("undulation", !undulates_,
                !accepted ? "not accepted" : fmt::format("the setpoints swing by up to {:.2f} rad", swing_rad),
                "offer this method: navigation drives by it while the body holds an object");
  if (!undulates_) {
    for (const char* name : {"frequency", "amplitude", "forwards", "backwards", "curvature"})
      report_.skip(name, "the robot does not undulate");
    return;
  }
  judge_wave(steps);
  check_curvature();
}

void ControlConformance::judge_wave(const Steps& steps) {
  const double link_m = robot_.module_length_m * static_cast<double>(yaw_[1] - yaw_[0]);
  const double step_rad = 2.0 * kPi * link_m / profile_.wavelength_m;  // of the wave from joint to joint
  /// [rad] median phase of a joint minus that of the joint in front of it.
  const auto lag_rad = [&](const Steps& some) {
    std::vector<double> lags;
    for (std::size_t k = yaw_.size() / 3; k + 1 < yaw_.size(); ++k) {
      const double lag =
          fitted(some, yaw_[k + 1], profile_.rate_hz).phase_rad - fitted(some, yaw_[k], profile_.rate_hz).phase_rad;
      lags.push_back(std::remainder(lag, 2.0 * kPi));
    }
    return median(std::move(lags));
  };
  const Fit middle = fitted(steps, yaw_[yaw_.size() / 2], profile_.rate_hz);
  report_.judge("frequency", middle.explained < 0.8,
                fmt::format("{:.2f} Hz, with {:.2f} Hz demanded", middle.seen_hz, profile_.rate_hz),
                "advance the phase by 2 pi frequency_hz in a second of simulated time");
  // Links whose headings swing by A with this phase between them: the joint angle is the difference of two of them.
  const double expected_rad = 2.0 * profile_.amplitude_rad * std::abs(std::sin(0.5 * step_rad));
  const double ratio = middle.amplitude_rad / expected_rad;
  report_.judge("amplitude", std::abs(ratio - 1.0) > profile_.gain_tolerance,
                fmt::format("{:.2f} times the demanded amplitude", ratio),
                "amplitude_rad [rad] is that of the links' heading, not of the joint angles");
  const double forwards_rad = lag_rad(steps);
  const bool wrong_way = forwards_rad > 0.0;
  const bool wrong_length = std::abs(-forwards_rad / step_rad - 1.0) > profile_.gain_tolerance;
  report_.judge("forwards", wrong_way || wrong_length,
                wrong_way ? std::string("the wave travels to the head")
                          : fmt::format("the wave is {:.2f} m long, and travels to the tail",
                                        2.0 * kPi * link_m / std::max(-forwards_rad, 1e-3)),
                "a wave that travels to the tail pushes the robot forwards; check wavelength_m [m]");
  undulate(-profile_.rate_hz, 0.0);
  go(profile_.settle_s);
  const double backwards_rad = lag_rad(go(kPeriods / profile_.rate_hz));
  report_.judge("backwards", backwards_rad < 0.0,
                fmt::format("the wave travels to the {}", backwards_rad < 0.0 ? "tail" : "head"),
                "turn the wave round when frequency_hz is negative");
}

void ControlConformance::check_curvature() {
  const auto bend_1_m = [&](double curvature_1_m) {
    undulate(profile_.rate_hz, curvature_1_m);
    go(profile_.settle_s);
    const Steps steps = go(kPeriods / profile_.rate_hz);
    double sum_rad = 0.0;
    for (std::size_t k = 1; k < yaw_.size(); ++k) sum_rad += fitted(steps, yaw_[k], profile_.rate_hz).mean_rad;
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
                "add curvature_1_m times the distance of two joints to each yaw angle; positive is left");
}

void ControlConformance::check_drive() {
  hand_.begin("drive");
  hand_.desired->frequency_hz = profile_.rate_hz;
  hand_.desired->amplitude_rad = profile_.amplitude_rad;
  hand_.desired->wavelength_m = profile_.wavelength_m;
  go(profile_.settle_s);
  const Steps steps = go(1.0 / profile_.rate_hz);
  const msg::MotionStatus* state = last_state(steps);
  const std::string method = state ? printable(text_of(state->method)) : "";
  const double swing_rad = moved_rad(steps, 0.0);
  const bool wrong = state == nullptr || !state->accepted || method.empty() || method == "drive" || swing_rad < 0.02;
  report_.judge(
      "drive", wrong,
      state && state->accepted ? fmt::format("drives by '{}', {:.2f} rad", method, swing_rad) : "not accepted",
      "choose the method that moves the robot, and name it in motion_status");
  hand_.begin("hold");
  const Steps held = go(1.5);
  state = last_state(held);
  const double moved = moved_rad(held, 0.5);
  report_.judge("hold", moved > profile_.posture_rad || state == nullptr || !state->accepted,
                state && state->accepted ? fmt::format("{:.3f} rad after half a second", moved) : "not accepted",
                "keep the posture in which the motion began");
}

}  // namespace constrictor::conform
