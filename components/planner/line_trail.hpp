// The planner's memory of the line: where it was seen, and which direction along it leads to the objects.
#pragma once

#include <cereal/types/vector.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// A point of the line in the map's frame M, with the direction that leads along the line to the objects.
struct TrailPoint {
  double x_m = 0.0, y_m = 0.0;
  double outbound_rad = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, outbound_rad);
  }
};

/// A point of the line in M.
struct LinePoint {
  double x_m = 0.0, y_m = 0.0;
  bool known = false;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, known);
  }
};

/// Recorded from percepts and pose estimates while the robot follows the line. The directions follow from the robot's
/// own way; nothing is known in advance. "Outbound" is the direction towards the objects.
class LineTrail {
 public:
  /// Adds the point of the line at the lookahead of a percept taken at `pose`. `outbound`: the robot follows the line
  /// towards the objects. Known points (within 0.3 m) keep their direction. A percept without a visible line is
  /// ignored, and so is one whose direction is opposite to that of the nearest point: the robot goes the wrong way.
  void record(const msg::LinePercept& line, const msg::RobotPose& pose, bool outbound);
  /// Stores the farthest visible point of the line if it lies near, or beyond, the last point followed outbound.
  void note_beyond(const msg::LinePercept& line, const msg::RobotPose& pose);
  /// Whether the visible line continues, in any direction, over new ground beyond the last point followed outbound. The
  /// less certain the pose, the farther from the known line this ground must be.
  [[nodiscard]] bool leads_to_new_ground(const msg::LinePercept& line, const msg::RobotPose& pose) const;
  /// [rad] in M, direction of the line beside the pose, towards the objects or back; empty: no point of the line is
  /// known.
  [[nodiscard]] std::optional<double> direction_rad(const msg::RobotPose& pose, bool outbound) const;
  /// Whether the robot can go straight to a point of M.
  using Reachable = std::function<bool(double x_m, double y_m)>;
  /// [rad] heading in M that leads along the line in that direction. Away from the line: towards a point of the line a
  /// little further on; if obstacles are in the way, towards the nearest such point that is reachable. Outbound, where
  /// the line was lost behind a bend: towards its last visible point.
  [[nodiscard]] std::optional<double> heading_rad(const msg::RobotPose& pose, bool outbound,
                                                  const Reachable& reachable = {}) const;
  /// Turns every direction round: the robot has followed the line the wrong way.
  void reverse();
  [[nodiscard]] bool empty() const { return points_.empty(); }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(points_, frontier_, beyond_);
  }

 private:
  [[nodiscard]] const TrailPoint* nearest(double x_m, double y_m) const;
  /// Whether a point of M is near the frontier.
  [[nodiscard]] bool at_frontier(double x_m, double y_m) const;
  std::vector<TrailPoint> points_;
  LinePoint frontier_;  ///< the newest point recorded outbound
  LinePoint beyond_;    ///< the newest visible point of the line near the frontier or beyond
};

}  // namespace constrictor
