#include "conform/plant_hand.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor::conform {
namespace {

constexpr std::size_t kMostKept = 1000;
constexpr double kEscape_amplitudes = 3.0;

}  // namespace

PlantHand::PlantHand(PlantPort& port, const RobotModel& robot, const PlantProfile& profile)
    : port_(port), robot_(robot), profile_(profile), setpoints_rad_(robot.joints.size()) {
  restore_torque();
}

void PlantHand::restore_torque() {
  limits_nm_.clear();
  for (const auto& joint : robot_.joints) limits_nm_.push_back(joint.max_torque_nm * profile_.torque_share);
}

void PlantHand::advance(const std::vector<PlantCommand>& commands, std::vector<JointSample>* samples) {
  port_.advance(commands);
  if (!port_.joints().empty()) newest_ = port_.joints().back();
  if (samples) samples->insert(samples->end(), port_.joints().begin(), port_.joints().end());
  if (imus_.size() < kMostKept) imus_.insert(imus_.end(), port_.imus().begin(), port_.imus().end());
  if (contacts_.size() < kMostKept) contacts_.insert(contacts_.end(), port_.contacts().begin(), port_.contacts().end());
}

std::vector<JointSample> PlantHand::send(const std::vector<PlantCommand>& commands, double seconds) {
  std::vector<JointSample> samples;
  const auto periods = std::max(1L, std::lround(seconds / profile_.period_s));
  for (long i = 0; i < periods; ++i) advance(commands, &samples);
  return samples;
}

std::vector<JointSample> PlantHand::watch(double seconds) { return send({}, seconds); }

PlantCommand PlantHand::command() const {
  PlantCommand command;
  command.position_rad = setpoints_rad_;
  command.velocity_rad_s.resize(setpoints_rad_.size());
  command.torque_limit_nm = limits_nm_;
  command.torque_nm.resize(setpoints_rad_.size());
  return command;
}

void PlantHand::return_to(const std::vector<double>& goals_rad) {
  const double step_rad = profile_.rate_rad_s * profile_.period_s;
  for (bool there = false; !there;) {
    there = true;
    PlantCommand now = command();
    for (std::size_t i = 0; i < setpoints_rad_.size(); ++i) {
      const double left_rad = goals_rad[i] - setpoints_rad_[i];
      there = there && std::abs(left_rad) <= step_rad;
      setpoints_rad_[i] += std::clamp(left_rad, -step_rad, step_rad);
      if (left_rad != 0.0) now.velocity_rad_s[i] = std::clamp(left_rad, -step_rad, step_rad) / profile_.period_s;
    }
    now.position_rad = setpoints_rad_;
    advance({now}, nullptr);
  }
  hold(profile_.settle_s);
}

void PlantHand::begin_at_posture() {
  if (!newest_) return;
  for (std::size_t i = 0; i < setpoints_rad_.size() && i < newest_->position_rad.size(); ++i) {
    const double angle_rad = newest_->position_rad[i];
    const auto& joint = robot_.joints[i];
    if (std::isfinite(angle_rad)) setpoints_rad_[i] = std::clamp(angle_rad, joint.min_rad, joint.max_rad);
  }
}

double PlantHand::goal_rad(std::size_t joint) const {
  const auto& model = robot_.joints[joint];
  const double middle_rad = 0.5 * (model.min_rad + model.max_rad);
  const double amplitude_rad = profile_.amplitude_rad;
  return setpoints_rad_[joint] + (setpoints_rad_[joint] > middle_rad + amplitude_rad ? -amplitude_rad : amplitude_rad);
}

std::vector<double> PlantHand::mean_rad(const std::vector<JointSample>& samples) const {
  std::vector<double> mean(setpoints_rad_.size());
  double used = 0.0;
  for (const auto& sample : samples) {
    if (sample.position_rad.size() != mean.size()) continue;
    used += 1.0;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (sample.position_rad[i] - mean[i]) / used;
  }
  return mean;
}

std::vector<Instant> PlantHand::move(std::size_t joint, double goal_rad, bool* escaped) {
  std::vector<Instant> motion;
  const double step_rad = profile_.rate_rad_s * profile_.period_s;
  long settling = std::max(1L, std::lround(profile_.settle_s / profile_.period_s));
  while (settling > 0) {
    const double left_rad = goal_rad - setpoints_rad_[joint];
    if (left_rad == 0.0) --settling;
    setpoints_rad_[joint] += std::clamp(left_rad, -step_rad, step_rad);
    if (std::abs(left_rad) <= step_rad) setpoints_rad_[joint] = goal_rad;
    PlantCommand now = command();
    if (left_rad != 0.0) now.velocity_rad_s[joint] = std::copysign(profile_.rate_rad_s, left_rad);
    advance({now}, nullptr);
    if (!newest_) continue;
    for (const auto& sample : port_.joints()) motion.push_back({port_.now_s(), setpoints_rad_[joint], sample});
    if (port_.joints().empty()) motion.push_back({port_.now_s(), setpoints_rad_[joint], *newest_});
    for (std::size_t i = 0; escaped && i < newest_->position_rad.size() && i < setpoints_rad_.size(); ++i) {
      const double far_rad = std::abs(newest_->position_rad[i] - setpoints_rad_[i]);
      if (far_rad < kEscape_amplitudes * profile_.amplitude_rad) continue;
      *escaped = true;
      begin_at_posture();
      hold(profile_.settle_s);
      return motion;
    }
  }
  return motion;
}

}  // namespace constrictor::conform
