// Recognises that a robot with an object does not move, because it is caught on an obstacle that it does not see, and
// chooses the moves that lead it to another place.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "constrictor/messages.hpp"

namespace constrictor {

/// One move of a search.
struct Move {
  std::uint8_t task = msg::kTaskNone;  ///< kTaskRotate or kTaskExplore
  std::uint8_t direction = msg::kDirectionNone;
};

/// Notices that the robot has not left its place for a while, and leads it away: backwards, round to one side, and
/// forwards again; the next time round to the other side.
class Standstill {
 public:
  /// A state of the mission begins at the present place of the robot.
  void begin() { since_s_ = -1.0; }
  /// The object is gone, and with it the moves that were to lead it away.
  void end() {
    moves_left_ = 0;
    leading_ = false;
  }
  /// Takes the place [m] in M of the held object, or of the head if the map has no held object, and the time [s].
  /// Returns whether the robot stands still: whether it has stayed within `near_m` of one place for `after_s`. The next
  /// moves of a search then lead away.
  bool notice(double x_m, double y_m, double now_s, double near_m, double after_s) {
    const bool away = std::hypot(x_m - x_m_, y_m - y_m_) > near_m;
    const bool still = moves_left_ == 0 && since_s_ >= 0.0 && !away && now_s - since_s_ > after_s;
    if (still) lead_away();
    if (since_s_ < 0.0 || away || moves_left_ > 0) {
      x_m_ = x_m;
      y_m_ = y_m;
      since_s_ = now_s;
    }
    return still;
  }
  /// The next moves of a search lead away from here, also if the robot does not stand still.
  void lead_away() {
    if (moves_left_ > 0) return;
    moves_left_ = kMoves;
    ++times_;
  }
  /// Whether moves that lead away are still to come: what the robot sees meanwhile has not freed it.
  [[nodiscard]] bool leads_away() const { return moves_left_ > 0; }
  /// Whether the present move leads away. It is short: an object may slip out of a U that drives backwards for long.
  [[nodiscard]] bool leading() const { return leading_; }
  /// The next move, if it must lead away. Call it once for each move of a search, after notice().
  std::optional<Move> next() {
    leading_ = moves_left_ > 0;
    if (!leading_) return std::nullopt;
    switch (moves_left_--) {
      case 1:
        return Move{msg::kTaskExplore, msg::kDirectionForwards};
      case 2:
        return Move{msg::kTaskRotate, times_ % 2 == 1 ? msg::kDirectionRight : msg::kDirectionLeft};
      default:
        return Move{msg::kTaskExplore, msg::kDirectionBackwards};
    }
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m_, y_m_, since_s_, times_, moves_left_, leading_);
  }

 private:
  static constexpr std::uint8_t kMoves = 4;  // two backwards, one turn, one forwards
  double x_m_ = 0.0, y_m_ = 0.0;             // the place that the robot has not left
  double since_s_ = -1.0;                    // since then; negative: not known
  std::uint16_t times_ = 0;
  std::uint8_t moves_left_ = 0;
  bool leading_ = false;
};

}  // namespace constrictor
