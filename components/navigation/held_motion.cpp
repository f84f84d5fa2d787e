#include "navigation/held_motion.hpp"

#include <algorithm>
#include <cmath>

#include "robot/planar.hpp"

namespace constrictor {
namespace {

constexpr double kDriving_m = 0.03;   // in one period; a slower object shows no direction
constexpr double kLargest_rad = 0.6;  // a larger angle is not a crab angle: the robot turns

double direction_rad(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

}  // namespace

void HeldMotion::observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s,
                         const Config& config) {
  const double since_s = samples_.empty() ? 0.0 : time_s - samples_.back()[0];
  period_s_ = period_s;
  samples_.push_back({time_s, p_M.x(), p_M.y(), mouth_rad});
  while (samples_.front()[0] < time_s - 2.0 * period_s) samples_.pop_front();
  const Means now = means();
  const auto pivot = [&](const Mean& mean) -> Eigen::Vector2d { return mean.place + config.pivot_m * mean.mouth; };
  const Eigen::Vector2d way = pivot(now.last) - pivot(now.before);
  if (!now.two_periods || way.norm() < kDriving_m) return;
  const double angle = direction_rad(way) - direction_rad(now.last.mouth + now.before.mouth);
  const double sample_rad = std::clamp(wrap_angle(angle), -kLargest_rad, kLargest_rad);
  // The first samples form a plain mean, which begins at 0 as if one period had shown that.
  crab_s_ += since_s;
  const double share = std::min(1.0, since_s / std::max(1e-6, std::min(crab_s_ + period_s, config.filter_s)));
  crab_rad_ += share * (sample_rad - crab_rad_);
}

Eigen::Vector2d HeldMotion::place() const {
  const Means now = means();
  return now.two_periods ? Eigen::Vector2d(now.last.place + 0.5 * (now.last.place - now.before.place)) : now.last.place;
}

double HeldMotion::heading_rad() const {
  const Means now = means();
  const double last_rad = direction_rad(now.last.mouth);
  return now.two_periods ? last_rad + 0.5 * wrap_angle(last_rad - direction_rad(now.before.mouth)) : last_rad;
}

HeldMotion::Means HeldMotion::means() const {
  std::array<Mean, 2> sum;
  std::array<int, 2> count{0, 0};
  for (const auto& [time_s, x_m, y_m, mouth_rad] : samples_) {
    const std::size_t older = time_s < samples_.back()[0] - period_s_ ? 1 : 0;
    sum[older].place += Eigen::Vector2d(x_m, y_m);
    sum[older].mouth += along(mouth_rad);
    ++count[older];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    sum[i].place /= std::max(1, count[i]);
    sum[i].mouth.normalize();
  }
  return {sum[0], sum[1], samples_.back()[0] - samples_.front()[0] > 1.9 * period_s_};
}

}  // namespace constrictor
