#include "navigation/held_motion.hpp"

#include <algorithm>
#include <cmath>

#include "robot/planar.hpp"

namespace constrictor {
namespace {

// A loaded body may rock with half of the gait's frequency, so that it moves left in one period and right in the next.
constexpr double kPeriods = 2.0;      // of the gait that are one window of the means
constexpr double kDriving_m = 0.015;  // in one window; a slower object shows no direction
constexpr double kLargest_rad = 0.6;  // a larger angle is not a crab angle: the robot turns

double direction_rad(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

}  // namespace

HeldMotion::Motion HeldMotion::observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s,
                                       const Config& config) {
  const double since_s = samples_.empty() ? 0.0 : time_s - samples_.back()[0];
  samples_.push_back({time_s, p_M.x(), p_M.y(), mouth_rad});
  while (samples_.front()[0] < time_s - 2.0 * kPeriods * period_s) samples_.pop_front();
  const Mean last = mean(0.0, period_s);
  const double last_rad = direction_rad(last.mouth);
  if (!observed(2.0 * period_s)) return {last.place, last_rad, crab_rad_};
  if (observed(2.0 * kPeriods * period_s)) {
    observe_crab(mean(0.0, kPeriods * period_s), mean(kPeriods * period_s, 2.0 * kPeriods * period_s), since_s,
                 kPeriods * period_s, config);
  }
  const Mean before = mean(period_s, 2.0 * period_s);
  return {last.place + 0.5 * (last.place - before.place),
          last_rad + 0.5 * wrap_angle(last_rad - direction_rad(before.mouth)), crab_rad_};
}

void HeldMotion::observe_crab(const Mean& last, const Mean& before, double since_s, double window_s,
                              const Config& config) {
  const Eigen::Vector2d way = last.place + config.pivot_m * last.mouth - (before.place + config.pivot_m * before.mouth);
  const Eigen::Vector2d mouth = (last.mouth + before.mouth).normalized();
  const Eigen::Vector2d way_U(mouth.dot(way), mouth.x() * way.y() - mouth.y() * way.x());
  way_s_ += since_s;
  // The first ways form a plain mean, which begins straight ahead as if one window had shown that. The ways are
  // filtered, and not their angles: the mean of angles depends on how far the object moved in each.
  const double share = std::min(1.0, since_s / std::max(1e-6, std::min(way_s_ + window_s, config.filter_s)));
  way_U_ += share * (way_U - way_U_);
  if (way_U_.norm() >= kDriving_m) crab_rad_ = std::clamp(direction_rad(way_U_), -kLargest_rad, kLargest_rad);
}

HeldMotion::Mean HeldMotion::mean(double from_s, double to_s) const {
  Mean mean;
  int count = 0;
  for (const auto& [time_s, x_m, y_m, mouth_rad] : samples_) {
    const double age_s = samples_.back()[0] - time_s;
    if (age_s < from_s || age_s >= to_s) continue;
    mean.place += Eigen::Vector2d(x_m, y_m);
    mean.mouth += along(mouth_rad);
    ++count;
  }
  mean.place /= std::max(1, count);
  mean.mouth.normalize();
  return mean;
}

bool HeldMotion::observed(double duration_s) const {
  return samples_.back()[0] - samples_.front()[0] > 0.95 * duration_s;
}

}  // namespace constrictor
