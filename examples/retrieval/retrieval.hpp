// How the two example planners fetch objects: a small state machine of its own on the task layer's vocabulary. It knows neither
// DDS nor any vendor's generated types, so that one logic serves both; each example translates its messages into the structs here.
// It has no clock: time comes with every call, from the messages' headers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retrieval {

// Numbers of idl/constrictor/task.idl that the logic speaks of.
enum Task : std::uint8_t { kNoTask, kFollowLine, kSearchObject, kTrackObject, kPregrasp, kGrasp, kDrop, kRotate, kExplore, kFollowPath };
enum Event : std::uint8_t { kLineLost = 2, kEndOfLine = 3, kObjectGrasped = 9, kObjectGraspLost = 10, kDroppingDone = 11 };
enum GoalState : std::uint8_t { kRunning = 1, kSucceeded, kAborted, kPreempted, kCancelled, kRefused };
enum Direction : std::uint8_t { kLeft = 1, kRight, kForwards, kBackwards };

/// Where the line is, 0.35 m or so ahead of the head (LinePercept).
struct Line {
  bool visible = false;
  double lookahead_m = 0, offset_m = 0, heading_rad = 0;
};
/// An object or a zone in view (Blob of ObjectPercepts).
struct Thing {
  std::uint8_t colour = 0;
  bool zone = false;
  double range_m = 0, bearing_rad = 0;
};
/// The head in the map, and where the body points once it is straight (RobotPose).
struct Pose {
  double x_m = 0, y_m = 0, yaw_rad = 0, body_yaw_rad = 0;
};
/// What navigation does now (TaskStatus).
struct Doing {
  std::uint64_t goal = 0;  ///< own goal id; 0: somebody else's goal
  std::uint8_t task = 0, state = 0;
  bool carrying = false;
};
/// Something happened (TaskEvent).
struct Happening {
  std::uint64_t goal = 0;  ///< own goal id; 0: somebody else's goal
  std::uint8_t event = 0, state = 0, colour = 0;
};
/// The task that is wanted (Request of kind task).
struct Order {
  std::uint64_t goal = 0;  ///< own ids, from 1
  std::uint8_t task = kNoTask, line_colour = 0, object_colour = 0, zone_colour = 0, direction = 0;
  double timeout_s = 0;    ///< of rotate; 0: none
  std::vector<std::pair<double, double>> path;  ///< [m] of follow_path, in the map; at most 64 points
};

class Retrieval {
 public:
  /// Fetches one object of each colour of `sequence`, in that order, along the line of `line_colour`.
  Retrieval(std::vector<std::uint8_t> sequence, std::uint8_t line_colour) : remaining_(std::move(sequence)), line_colour_(line_colour) {}

  // What is seen and heard, also before the planner commands: it learns the way from whoever drives.
  void see(const Line& line);
  void see(const std::vector<Thing>& things);
  void locate(const Pose& pose) { pose_ = pose; }
  void know(const Doing& doing) { doing_ = doing; }
  void hear(const Happening& happening);

  /// Takes the mission up from the world as it is. To be called when authority was gained.
  void take_over(double time_s);
  /// The next order, if something else than the present one is to be done.
  std::optional<Order> decide(double time_s);

  [[nodiscard]] bool done() const { return remaining_.empty(); }
  [[nodiscard]] std::string stage() const;
  [[nodiscard]] int setbacks() const { return setbacks_; }
  [[nodiscard]] const std::vector<std::uint8_t>& remaining() const { return remaining_; }

 private:
  enum Stage { kLook, kFollow, kSearch, kTrack, kPre, kHold, kFindLine, kCarry, kPutDown, kTurn, kTurnBack };
  struct Crumb { double x_m, y_m, outbound_rad; };

  [[nodiscard]] bool loaded() const { return stage_ == kFindLine || stage_ == kCarry || stage_ == kPutDown || stage_ == kTurnBack; }
  [[nodiscard]] std::uint8_t colour() const { return remaining_.empty() ? std::uint8_t{0} : remaining_.front(); }
  void enter(Stage stage);
  void set_back(Stage stage);
  void follow_goal();
  void follow_senses();
  void follow_time();
  [[nodiscard]] const Crumb* nearest_crumb(double x_m, double y_m) const;
  /// [rad] Where the robot drives to when it drives on. A body that is curled up from turning points elsewhere than its head.
  [[nodiscard]] double course_rad() const { return loaded() ? pose_.yaw_rad : pose_.body_yaw_rad; }
  /// [rad] between the course and the wanted way along the line here, positive left; empty: the way is not known.
  [[nodiscard]] std::optional<double> off_line_rad() const;
  /// [rad] to turn left towards what is looked for, by memory: the thing, else the line.
  [[nodiscard]] std::optional<double> to_turn_rad() const;
  [[nodiscard]] bool has_turned() const;
  [[nodiscard]] bool may_follow() const;
  Order order_of_stage();
  void look_round(Order& order);
  /// From here to the line as it is remembered and along it the wanted way; empty: not known.
  [[nodiscard]] std::vector<std::pair<double, double>> way_back() const;

  std::vector<std::uint8_t> remaining_;
  std::uint8_t line_colour_;
  Pose pose_;
  Doing doing_;
  Line line_;
  std::vector<Crumb> trail_;  ///< the line, with the way that leads to the objects
  std::map<std::pair<std::uint8_t, bool>, std::pair<double, double>> places_;  ///< [m] (colour, zone?) -> last seen there, in the map
  std::vector<Happening> heard_;
  std::uint8_t held_ = 0;      ///< colour of what was grasped last and not dropped
  Stage stage_ = kLook;
  double now_s_ = 0, since_s_ = 0, asked_s_ = 0, line_end_s_ = -1e9, unlike_since_s_ = 0;
  bool asked_ = true;          ///< nothing is ordered before take_over
  bool in_command_ = false;
  std::uint64_t goal_ = 0;
  int lines_ = 0, objects_ = 0, zones_ = 0;  ///< images in a row in which each was seen
  unsigned looks_ = 0;
  std::uint8_t looking_ = kNoTask;
  bool by_memory_ = false;     ///< the present look round goes where something is remembered
  bool turning_left_ = false;
  int setbacks_ = 0;
};

}  // namespace retrieval
