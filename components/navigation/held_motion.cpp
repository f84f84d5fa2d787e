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

HeldMotion::Motion HeldMotion::observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s,
                                       const Config& config) {
  const double since_s = samples_.empty() ? 0.0 : time_s - samples_.back()[0];
  samples_.push_back({time_s, p_M.x(), p_M.y(), mouth_rad});
  while (samples_.front()[0] < time_s - 2.0 * period_s) samples_.pop_front();
  const auto [last, before, two_periods] = means(period_s);
  const double last_rad = direction_rad(last.mouth);
  if (!two_periods) return {last.place, last_rad, crab_rad_};
  const Eigen::Vector2d way = last.place + config.pivot_m * last.mouth - (before.place + config.pivot_m * before.mouth);
  if (way.norm() >= kDriving_m) {
    const double angle = direction_rad(way) - direction_rad(last.mouth + before.mouth);
    const double sample_rad = std::clamp(wrap_angle(angle), -kLargest_rad, kLargest_rad);
    // The first samples form a plain mean, which begins at 0 as if one period had shown that.
    crab_s_ += since_s;
    const double share = std::min(1.0, since_s / std::max(1e-6, std::min(crab_s_ + period_s, config.filter_s)));
    crab_rad_ += share * (sample_rad - crab_rad_);
  }
  return {last.place + 0.5 * (last.place - before.place),
          last_rad + 0.5 * wrap_angle(last_rad - direction_rad(before.mouth)), crab_rad_};
}

HeldMotion::Means HeldMotion::means(double period_s) const {
  std::array<Mean, 2> sum;
  std::array<int, 2> count{0, 0};
  for (const auto& [time_s, x_m, y_m, mouth_rad] : samples_) {
    const std::size_t older = time_s < samples_.back()[0] - period_s ? 1 : 0;
    sum[older].place += Eigen::Vector2d(x_m, y_m);
    sum[older].mouth += along(mouth_rad);
    ++count[older];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    sum[i].place /= std::max(1, count[i]);
    sum[i].mouth.normalize();
  }
  return {sum[0], sum[1], samples_.back()[0] - samples_.front()[0] > 1.9 * period_s};
}

}  // namespace constrictor
