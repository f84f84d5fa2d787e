#include "navigation/mapped_line.hpp"

#include <cmath>
#include <limits>

#include "robot/map_points.hpp"

namespace constrictor {
namespace {

/// The lateral offset [m] of the line at a distance from the head: that of the point nearest to the head's axis among
/// those at about this distance.
class OffsetAt {
 public:
  OffsetAt(double ahead_m, double aside_m) : ahead_m_(ahead_m), least_m_(aside_m) {}
  void look_at(const Eigen::Vector2d& p_H) {
    constexpr double kBand_m = 0.15;
    if (std::abs(p_H.x() - ahead_m_) > kBand_m || std::abs(p_H.y()) > least_m_) return;
    least_m_ = std::abs(p_H.y());
    found_m_ = p_H.y();
  }
  [[nodiscard]] double get_m() const { return found_m_; }  ///< NaN: no such point

 private:
  double ahead_m_, least_m_;
  double found_m_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

std::optional<PlanarPose> mapped_line_H(const msg::FieldMap& map, const PlanarPose& X_MH, double lookahead_m,
                                        double aside_m, double reach_m) {
  constexpr double kFurther_m = 0.4;
  constexpr double kCone = 1.732;  // tangent of 60 degrees
  constexpr double kBend = 0.577;  // tangent of 30 degrees
  constexpr double kRing_m = 0.1;
  OffsetAt here(lookahead_m, aside_m), further(lookahead_m + kFurther_m, aside_m);
  std::optional<Eigen::Vector2d> nearest;  // within reach_m and 60 degrees of the heading
  std::optional<Eigen::Vector2d> beside;   // at about lookahead_m and more than 30 degrees from the heading
  each_line_point(map, [&](const Eigen::Vector2d& p_M) {
    const Eigen::Vector2d p = X_MH.to_local(p_M);
    here.look_at(p);
    further.look_at(p);
    const bool bends_away = std::abs(p.y()) > kBend * p.x() && p.x() > 0.0;
    if (bends_away && std::abs(p.norm() - lookahead_m) < kRing_m && (!beside || p.x() > beside->x())) beside = p;
    if (p.norm() < (nearest ? nearest->norm() : reach_m) && std::abs(p.y()) < kCone * p.x()) nearest = p;
  });
  const double more_m = further.get_m() - here.get_m();
  if (std::abs(more_m) < kFurther_m)  // false for NaN
    return PlanarPose{{lookahead_m, here.get_m()}, std::atan2(more_m, kFurther_m)};
  if (!nearest || nearest->x() < lookahead_m) {
    if (!beside) return std::nullopt;
    return PlanarPose{*beside, std::atan2(beside->y(), beside->x())};  // the head points out of a bend
  }
  // The line begins farther ahead: the straight way to its nearest point counts as a line.
  return PlanarPose{{lookahead_m, lookahead_m * nearest->y() / nearest->x()}, std::atan2(nearest->y(), nearest->x())};
}

}  // namespace constrictor
