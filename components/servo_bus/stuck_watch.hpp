// Finds joints that do not move although their goals do: a jammed gear, a broken gear, a blocked joint.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "robot/joint_limits.hpp"

namespace constrictor {

/// A joint that only yields to a load, as in a grasp, is not stuck: there the goals stand still.
class StuckWatch {
 public:
  /// Between these two ranges of motion within a window [rad], a joint counts neither as stuck nor as free again.
  static constexpr double kStill_rad = 0.03, kMoves_rad = 0.1;
  static constexpr double kGoalMoves_rad = 0.3;

  struct Change {
    std::size_t joint = 0;
    bool stuck = false;     ///< false: it moves again
    double goal_rad = 0.0;  ///< the range of its goals within the window
  };

  /// `window_ticks`: a joint is looked at over so many ticks; 0: never.
  StuckWatch(std::size_t joints, int window_ticks) : window_ticks_(window_ticks), joints_(joints) {}
  /// Takes the goals of this tick and the measured angles [rad], one for each joint. Returns what has changed.
  std::vector<Change> look(std::span<const JointSetpoint> goals, std::span<const double> angles_rad);

 private:
  struct Range {
    double min = 0.0, max = 0.0;
    void add(double value, bool first);
    [[nodiscard]] double width() const { return max - min; }
  };
  struct Joint {
    Range goal, angle;
    bool driven = false;  ///< it followed goals in every tick of the window
    bool stuck = false;
  };
  int window_ticks_;
  int ticks_ = 0;  ///< of the present window
  std::vector<Joint> joints_;
};

}  // namespace constrictor
