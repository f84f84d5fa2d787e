// How the two example planners retrieve objects: a state machine that decides which task to start next. It uses neither
// DDS nor generated message types, so that it serves planners on any vendor's DDS: each planner translates its messages
// into the structs below. It reads no clock: time is an argument, from the headers of the messages.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retrieval {

inline constexpr double kPi = 3.14159265358979323846;
/// Largest angle [rad] between course and wanted direction at which the course is accepted.
inline constexpr double kAligned_rad = 1.0;

/// The equivalent angle in [-pi, pi].
inline double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * kPi); }

// The constants of idl/constrictor/task.idl that the logic needs.
enum Task : std::uint8_t {
  kNoTask,
  kFollowLine,
  kSearchObject,
  kTrackObject,
  kPregrasp,
  kGrasp,
  kDrop,
  kRotate,
  kExplore,
  kFollowPath
};
enum Event : std::uint8_t {
  kLineLost = 2,
  kEndOfLine = 3,
  kObjectGrasped = 9,
  kObjectGraspLost = 10,
  kDroppingDone = 11
};
enum GoalState : std::uint8_t { kRunning = 1, kSucceeded, kAborted, kPreempted, kCancelled, kRefused };
enum Direction : std::uint8_t { kLeft = 1, kRight, kForwards, kBackwards };

/// The line in view (LinePercept): its offset and heading about 0.35 m ahead of the head.
struct Line {
  bool visible = false;
  double lookahead_m = 0, offset_m = 0, heading_rad = 0;
};
/// An object or a zone in view (Blob of ObjectPercepts).
struct Percept {
  std::uint8_t colour = 0;
  bool zone = false;
  double range_m = 0, bearing_rad = 0;
};
/// Pose of the head in the map, and the heading of the body (RobotPose).
struct Pose {
  double x_m = 0, y_m = 0, yaw_rad = 0, body_yaw_rad = 0;
};
/// The present goal of navigation (TaskStatus).
struct GoalStatus {
  std::uint64_t goal = 0;  ///< this planner's own number of the goal; 0: a goal of another source
  std::uint8_t task = 0, state = 0;
  bool carrying = false;
};
/// An event of a goal (TaskEvent).
struct GoalEvent {
  std::uint64_t goal = 0;  ///< this planner's own number of the goal; 0: a goal of another source
  std::uint8_t event = 0, state = 0, colour = 0;
};
/// The task to start next (a Request of kind task).
struct Order {
  std::uint64_t goal = 0;  ///< this planner's own number of the goal, from 1
  std::uint8_t task = kNoTask, line_colour = 0, object_colour = 0, zone_colour = 0, direction = 0;
  double timeout_s = 0;                         ///< [s] time limit of rotate; 0: no limit
  std::vector<std::pair<double, double>> path;  ///< [m] of follow_path, in the map; at most 64 points
};

class Retrieval {
 public:
  /// Retrieves one object of each colour in `sequence`, in that order, along the line of `line_colour`.
  Retrieval(std::vector<std::uint8_t> sequence, std::uint8_t line_colour)
      : remaining_(std::move(sequence)), line_colour_(line_colour) {}

  // To be called with every message, also before this planner has authority: the logic then knows the line that the
  // robot followed while another source had authority.
  void take(const Line& line);
  void take(const std::vector<Percept>& percepts);
  void take(const Pose& pose) { pose_ = pose; }
  void take(const GoalStatus& status) { status_ = status; }
  void take(const GoalEvent& event);

  /// Continues the mission from the present state of the world. To be called when this planner has gained authority.
  void take_over(double time_s);
  /// The order that replaces the present order; empty if the present order goes on.
  std::optional<Order> decide(double time_s);

  [[nodiscard]] bool done() const { return remaining_.empty(); }
  [[nodiscard]] std::string stage() const;
  [[nodiscard]] int setbacks() const { return setbacks_; }
  [[nodiscard]] const std::vector<std::uint8_t>& remaining() const { return remaining_; }

 private:
  enum Stage { kLook, kFollow, kSearch, kTrack, kPre, kHold, kFindLine, kCarry, kPutDown, kTurn, kTurnBack };
  struct TrailPoint {
    double x_m, y_m, outbound_rad;
  };

  [[nodiscard]] bool loaded() const {
    return stage_ == kFindLine || stage_ == kCarry || stage_ == kPutDown || stage_ == kTurnBack;
  }
  [[nodiscard]] std::uint8_t colour() const { return remaining_.empty() ? std::uint8_t{0} : remaining_.front(); }
  void enter(Stage stage);
  void set_back(Stage stage);
  void follow_goal();
  void follow_senses();
  void follow_time();
  [[nodiscard]] const TrailPoint* nearest_trail_point(double x_m, double y_m) const;
  /// [rad] Heading in which the robot moves when it drives forwards. It differs from the head's heading after a turn on
  /// the spot, because the body is then curled up.
  [[nodiscard]] double course_rad() const { return loaded() ? pose_.yaw_rad : pose_.body_yaw_rad; }
  /// [rad] Angle from the course to the wanted direction along the line, positive to the left; empty if the line is not
  /// known here.
  [[nodiscard]] std::optional<double> off_line_rad() const;
  /// [rad] Angle from the course to the remembered place of the object or zone, positive to the left. Without such a
  /// place: angle to the line.
  [[nodiscard]] std::optional<double> to_turn_rad() const;
  [[nodiscard]] bool has_turned() const;
  [[nodiscard]] bool may_follow() const;
  Order order_of_stage();
  void look_round(Order& order);
  /// [m] A path from the robot to the remembered line and along it in the wanted direction; empty if no line is known.
  [[nodiscard]] std::vector<std::pair<double, double>> way_back() const;

  std::vector<std::uint8_t> remaining_;
  std::uint8_t line_colour_;
  Pose pose_;
  GoalStatus status_;
  Line line_;
  std::vector<TrailPoint> trail_;  ///< points of the line, with the direction that leads to the objects
  std::map<std::pair<std::uint8_t, bool>, std::pair<double, double>>
      places_;                     ///< [m] last known place in the map, by (colour, whether it is a zone)
  std::vector<GoalEvent> events_;  ///< since the last decide()
  std::uint8_t held_ = 0;          ///< colour of the object that the robot holds
  Stage stage_ = kLook;
  double now_s_ = 0, since_s_ = 0, asked_s_ = 0, line_end_s_ = -1e9, differs_since_s_ = 0;
  bool asked_ = true;  ///< there are no orders before take_over()
  bool in_command_ = false;
  std::uint64_t goal_ = 0;
  int lines_ = 0, objects_ = 0, zones_ = 0;  ///< consecutive images that showed the line, the object, the zone
  unsigned looks_ = 0;
  std::uint8_t looking_ = kNoTask;
  bool by_memory_ = false;  ///< the present look round turns to a remembered place
  bool turning_left_ = false;
  int setbacks_ = 0;
};

}  // namespace retrieval
