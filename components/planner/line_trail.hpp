// Where the line was seen and which way along it leads to the objects: the planner's memory for the way back.
#pragma once

#include <cereal/types/vector.hpp>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// A point of the line in the map's frame M with the direction that leads to the objects there.
struct Crumb {
  double x_m = 0.0;
  double y_m = 0.0;
  double outbound_rad = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, outbound_rad);
  }
};

/// A point of the line in M.
struct LinePoint {
  double x_m = 0.0;
  double y_m = 0.0;
  bool known = false;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, known);
  }
};

/// Made while a line is followed, from percepts and the pose estimate: directions come from where the robot has been, not from
/// anything known beforehand.
class LineTrail {
 public:
  /// Takes the line at the lookahead of a percept seen from `pose`; `outbound` says which way it is being followed. Places known
  /// already (within 0.3 m) keep their direction. Ignores percepts without a visible line.
  void record(const msg::LinePercept& line, const msg::RobotPose& pose, bool outbound);
  /// Remembers the farthest point of the line in view if it lies where the line was last followed outbound, or beyond.
  void note_beyond(const msg::LinePercept& line, const msg::RobotPose& pose);
  /// Whether the line in view leads on over new ground, beyond where it was last followed outbound: after a bend, in any direction.
  [[nodiscard]] bool leads_on(const msg::LinePercept& line, const msg::RobotPose& pose) const;
  /// [rad] in M, direction along the line next to the pose that leads to the objects (or back); empty: no line known yet.
  [[nodiscard]] std::optional<double> direction_rad(const msg::RobotPose& pose, bool outbound) const;
  /// [rad] heading in M that leads along the line in that direction; from beside it, towards a place a little further along, where
  /// it is best joined; outbound from where it was lost behind a bend, towards where it was seen last.
  [[nodiscard]] std::optional<double> heading_rad(const msg::RobotPose& pose, bool outbound) const;
  /// It was the wrong way: every direction is the opposite.
  void reverse();
  [[nodiscard]] bool empty() const { return crumbs_.empty(); }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(crumbs_, frontier_, beyond_);
  }

 private:
  [[nodiscard]] const Crumb* nearest(double x_m, double y_m) const;
  /// Whether a point of M is about the frontier.
  [[nodiscard]] bool at_frontier(double x_m, double y_m) const;
  std::vector<Crumb> crumbs_;
  LinePoint frontier_;  ///< the newest crumb made outbound
  LinePoint beyond_;    ///< the newest point of the line seen there or beyond
};

/// Angle wrapped into [-pi, pi].
double wrapped(double angle_rad);

}  // namespace constrictor
