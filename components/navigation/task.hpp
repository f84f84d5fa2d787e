// The interface of the paper's tasks (Section III-A, Tables I to XV).
#pragma once

#include <cereal/archives/portable_binary.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "navigation/grip.hpp"
#include "navigation/line_watch.hpp"
#include "navigation/navigation_config.hpp"
#include "navigation/object_watch.hpp"
#include "navigation/planar_body.hpp"
#include "runtime/component.hpp"

namespace constrictor {

/// What a task is given at each step.
struct TaskInput {
  const Tick& tick;
  const RobotModel& robot;
  const NavigationConfig& config;
  const GripSense& grip_sense;
  const msg::TaskParameters& parameters;
  Pose2 X_MH;                          ///< the head in the map
  const msg::LinePercept* line;        ///< a new percept; null if none came since the previous step
  bool image;                          ///< new object percepts came since the previous step
  const ObjectWatchState& things;      ///< what is known of objects and zones
  const msg::FieldMap* map;            ///< null before the first
  const msg::JointState& joints;
  const std::vector<Pose2>& body;      ///< modules in the head's frame
  const std::vector<Touch>& touches;   ///< lateral, neither ground nor self
  bool motion_done;                    ///< control has finished the motion that was asked for last
  const msg::Path* path = nullptr;     ///< at a goal's start: of its command
};

struct EventRecord {
  std::uint8_t event = msg::kEventNone;
  std::uint8_t colour = msg::kColourUnknown;
  std::uint16_t handle = 0;
};

/// What a task answers.
struct TaskOutput {
  msg::DesiredTrajectory desired{};   ///< without motion_id
  bool new_motion = false;            ///< the motion begins afresh although its method is the same as before
  std::vector<EventRecord> events;
  std::uint8_t state = msg::kGoalRunning;  ///< or kGoalSucceeded, kGoalAborted: the goal ends with this step
  std::string reason;                 ///< why aborted
  double progress = 0.0;              ///< 0..1
  const char* phase = "";             ///< for people
  double cross_track_m = std::numeric_limits<double>::quiet_NaN();  ///< of a path being followed

  void emit(std::uint8_t event, std::uint8_t colour = msg::kColourUnknown, std::uint16_t handle = 0) {
    events.push_back({event, colour, handle});
  }
  void succeed() { state = msg::kGoalSucceeded; progress = 1.0; }
  void abort(std::string why) { state = msg::kGoalAborted; reason = std::move(why); }
};

/// One of the tasks. Made for a goal, stepped at every tick until the goal ends.
class Task {
 public:
  virtual ~Task() = default;
  /// Why this goal cannot be accepted; empty: it can. Nothing has happened yet.
  [[nodiscard]] virtual std::string refusal(const TaskInput& input, const Grip& grip) const = 0;
  virtual void start(const TaskInput& input, Grip& grip) = 0;
  virtual void step(const TaskInput& input, Grip& grip, TaskOutput& output) = 0;
  [[nodiscard]] virtual std::string save() const = 0;
  virtual void load(const std::string& bytes) = 0;
};

/// A task whose whole memory is one serialisable struct.
template <class State>
class StatefulTask : public Task {
 public:
  [[nodiscard]] std::string save() const final {
    std::ostringstream stream;
    cereal::PortableBinaryOutputArchive archive(stream);
    archive(state_);
    return std::move(stream).str();
  }
  void load(const std::string& bytes) final {
    std::istringstream stream(bytes);
    cereal::PortableBinaryInputArchive archive(stream);
    archive(state_);
  }

 protected:
  State state_{};
};

std::unique_ptr<Task> make_follow_line();
std::unique_ptr<Task> make_search_object();
std::unique_ptr<Task> make_track_object();
std::unique_ptr<Task> make_pregrasp();
std::unique_ptr<Task> make_grasp();
std::unique_ptr<Task> make_drop();
std::unique_ptr<Task> make_rotate();
std::unique_ptr<Task> make_explore();
std::unique_ptr<Task> make_follow_path();
/// By kTask…; null for kTaskNone and unknown numbers.
std::unique_ptr<Task> make_task(std::uint8_t kind);

}  // namespace constrictor
