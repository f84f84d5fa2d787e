// The part of FieldMapper that maps the line and corrects the pose by it.
#include <algorithm>
#include <cmath>

#include "guidance/field_mapper.hpp"

namespace constrictor::guidance {
namespace {

constexpr std::size_t kMaxLinePoints = 20000;  // 1 km with the default spacing; bounds the time of an image

}  // namespace

void FieldMapper::line(const msg::LinePercept& percept, const PlanarPose& exposure, std::int64_t tick,
                       double period_s) {
  if (!percept.visible) return;
  const PlanarPose view = view_of(percept, exposure);
  if (percept.colour != state_.line_colour) {
    state_.line_colour = percept.colour;
    state_.line_x_m.clear();
    state_.line_y_m.clear();
    state_.line_tick.clear();
  }
  const auto old_ticks = static_cast<std::int64_t>(std::llround(config_.line_correct_after_s / period_s));
  const int count = std::min<int>(percept.point_count, msg::kMaxPerceptPoints);
  const int stride = std::max(1, count / 4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p_V(percept.x_m[i], percept.y_m[i]);
    if (!p_V.allFinite() || p_V.norm() > config_.line_map_range_m) continue;
    const Eigen::Vector2d z = to_parent(view, p_V);
    const Eigen::Vector2d p = to_parent(filter_.pose(), z);

    // The mapped points near this point give the position and the direction of the line here.
    const double reach_m = std::max(3.0 * config_.line_spacing_m, config_.line_correct_gate_m);
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double nearest_m = 1e9;
    int near = 0;
    bool old = true;
    for (std::size_t k = 0; k < state_.line_x_m.size(); ++k) {
      const Eigen::Vector2d q(state_.line_x_m[k], state_.line_y_m[k]);
      const double apart_m = (q - p).norm();
      nearest_m = std::min(nearest_m, apart_m);
      if (apart_m > reach_m) continue;
      centre += q;
      ++near;
      old = old && tick - state_.line_tick[k] > old_ticks;
    }
    if (near >= 3 && old && i % stride == 0) {
      centre /= near;
      Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
      for (std::size_t k = 0; k < state_.line_x_m.size(); ++k) {
        const Eigen::Vector2d q(state_.line_x_m[k], state_.line_y_m[k]);
        if ((q - p).norm() <= reach_m) scatter += (q - centre) * (q - centre).transpose();
      }
      const double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
      const Eigen::Vector2d normal = left(angle);
      const double residual_m = normal.dot(p - centre);
      if (std::abs(residual_m) < config_.line_correct_gate_m) {
        const double sd_m = config_.line_correct_sd_m + 0.03 * p_V.norm();
        filter_.observe_line(residual_m, normal, p - filter_.pose().p, config_.inflation * sd_m * sd_m);
      }
    }
    if (nearest_m > config_.line_spacing_m && state_.line_x_m.size() < kMaxLinePoints) {
      state_.line_x_m.push_back(p.x());
      state_.line_y_m.push_back(p.y());
      state_.line_tick.push_back(tick);
    }
  }
}

}  // namespace constrictor::guidance
