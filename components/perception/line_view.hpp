// Evaluates the label image along cross-sections of the line.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/regions.hpp"

namespace constrictor::perception {

/// The content of the image at a point of the ground.
enum class Seen {
  kGround,
  kLine,
  kStanding,  ///< an upright object, the robot's own head or glare hides the point
  kOutside,   ///< the point is out of view
};

/// The content of a cross-section.
enum class Section {
  kGood,     ///< the line with both edges
  kOneEdge,  ///< the line; something hides its other edge
  kNothing,  ///< bare ground
  kHidden,   ///< an upright object hides the place where the line should be
  kOutside,  ///< this place is out of view
};

struct CrossSection {
  Section section = Section::kNothing;
  double centre_m = 0.0;  ///< centre of the line, to the left of the point; valid with kGood and kOneEdge
  double width_m = 0.0;   ///< of the visible part of the line; valid with kGood and kOneEdge
};

/// [m] size of a pixel on the ground, and what points and cross-sections of the ground show. Points in G. The arguments
/// of the constructor must outlive the object.
class LineView {
 public:
  LineView(const Labels& labels, const Regions& regions, const GroundCamera& camera, std::uint8_t colour)
      : labels_(labels), regions_(regions), camera_(camera), colour_(colour) {}

  /// Points of the line's colour that lie on the ground, up to `max_range_m`, the nearest first.
  [[nodiscard]] std::vector<Eigen::Vector2d> line_points(double max_range_m) const;
  [[nodiscard]] Seen look(const Eigen::Vector2d& p) const;
  /// [m] distance of a point from the camera, along the ground.
  [[nodiscard]] double range(const Eigen::Vector2d& p) const { return (p - camera_.position_on_ground()).norm(); }
  /// [m] size on the ground of a pixel at `p` in a direction.
  [[nodiscard]] double pixel_size_m(const Eigen::Vector2d& p, const Eigen::Vector2d& direction) const;
  /// Looks across the course at `p` for a line that is `width_m` wide. `slack_m`: how much farther from the course than
  /// usual the line may lie.
  [[nodiscard]] CrossSection cross_section(const Eigen::Vector2d& p, const Eigen::Vector2d& direction, double width_m,
                                           double slack_m) const;

 private:
  [[nodiscard]] bool is_standing(int u, int v) const;
  /// Whether bare ground lies beyond an edge, rather than the border of the image or an object that hides the line.
  [[nodiscard]] bool edge_is_open(int index, int step, int fringe) const;

  const Labels& labels_;
  const Regions& regions_;
  const GroundCamera& camera_;
  std::uint8_t colour_;
  mutable std::vector<Seen> seen_;  ///< the points of the present cross-section; kept to avoid allocations
};

/// The direction to the left of another.
inline Eigen::Vector2d left_of(const Eigen::Vector2d& d) { return {-d.y(), d.x()}; }

}  // namespace constrictor::perception
