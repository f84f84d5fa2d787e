#include "navigation/held_motion.hpp"

#include <algorithm>
#include <cmath>

#include "robot/planar.hpp"

namespace constrictor {
namespace {

constexpr double kDriving_m = 0.03;   // in one period; a slower object shows no direction
constexpr double kLargest_rad = 0.6;  // a larger angle is not a crab angle: the robot turns

}  // namespace

double steered_aside_m(const Eigen::Vector2d& p_HO, double lookahead_m, double crab_rad) {
  return -turned(p_HO - Eigen::Vector2d(lookahead_m, 0.0), -crab_rad).y();
}

void HeldMotion::observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s,
                         double filter_s) {
  const double since_s = samples_.empty() ? 0.0 : time_s - samples_.back()[0];
  period_s_ = period_s;
  samples_.push_back({time_s, p_M.x(), p_M.y(), mouth_rad});
  while (samples_.front()[0] < time_s - 2.0 * period_s) samples_.pop_front();
  const Means now = means();
  const Eigen::Vector2d way = now.last - now.before;
  if (!now.two_periods || way.norm() < kDriving_m || now.mouth.norm() < 1e-6) return;
  const double angle = std::atan2(way.y(), way.x()) - std::atan2(now.mouth.y(), now.mouth.x());
  const double sample_rad = std::clamp(wrap_angle(angle), -kLargest_rad, kLargest_rad);
  // The first samples form a plain mean, which begins at 0 as if one period had shown that.
  crab_s_ += since_s;
  const double share = std::min(1.0, since_s / std::max(1e-6, std::min(crab_s_ + period_s, filter_s)));
  crab_rad_ += share * (sample_rad - crab_rad_);
}

Eigen::Vector2d HeldMotion::place() const {
  const Means now = means();
  return now.two_periods ? Eigen::Vector2d(now.last + 0.5 * (now.last - now.before)) : now.last;
}

HeldMotion::Means HeldMotion::means() const {
  std::array<Eigen::Vector2d, 2> sum{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::array<int, 2> count{0, 0};
  Eigen::Vector2d mouth = Eigen::Vector2d::Zero();
  for (const auto& [time_s, x_m, y_m, mouth_rad] : samples_) {
    const std::size_t older = time_s < samples_.back()[0] - period_s_ ? 1 : 0;
    sum[older] += Eigen::Vector2d(x_m, y_m);
    ++count[older];
    mouth += along(mouth_rad);
  }
  const bool two_periods = samples_.back()[0] - samples_.front()[0] > 1.9 * period_s_;
  return {sum[0] / count[0], sum[1] / std::max(1, count[1]), mouth, two_periods};
}

}  // namespace constrictor
