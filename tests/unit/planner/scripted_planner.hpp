// A mission planner in a world of scripted percepts and events.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "constrictor/archive.hpp"
#include "planner/mission_planner.hpp"
#include "robot/landmarks.hpp"
#include "robot/planar.hpp"

namespace constrictor {

constexpr std::uint64_t kPlannerGoalBase = static_cast<std::uint64_t>(msg::kAuthorityPlanner) << 48;

/// A world of scripted percepts and events around a planner. A second planner makes every step, too, restored from the
/// saved state of the previous step: both must make the same requests and reach the same state.
class PlannerTest : public ::testing::Test {
 protected:
  PlannerTest() {
    config_.sequence = {msg::kColourGreen, msg::kColourRed};
    config_.line_colour = msg::kColourBlue;
    see_line(false);
  }

  /// Begins another mission, in a world where nothing is known.
  void forget() {
    memory_ = {};
    taken_.clear();
    pose_ = {};
    map_ = {};
  }

  std::optional<WantedTask> step(const std::vector<msg::TaskEvent>& events = {}) {
    PlannerInputs inputs;
    inputs.time_s = time_s_ += 0.02;
    inputs.tick = ++tick_;
    inputs.line = &line_;
    inputs.objects = &objects_;
    inputs.new_percepts = images_;
    inputs.pose = &pose_;
    inputs.map = &map_;
    inputs.authority = &authority_;
    if (with_status_) {
      // Navigation takes a goal three ticks after the request.
      taken_.push_back(memory_.goals);
      if (taken_.size() > 3) taken_.erase(taken_.begin());
      status_.goal_id = kPlannerGoalBase + taken_.front();
      status_.goal_state = msg::kGoalRunning;
      inputs.status = &status_;
    }
    for (const auto& event : events) inputs.events.push_back(&event);

    MissionMemory copy;
    load_bytes(save_bytes(memory_), copy);
    const auto again = MissionPlanner(config_, copy).step(inputs);
    const auto wanted = MissionPlanner(config_, memory_).step(inputs);
    EXPECT_EQ(again.has_value(), wanted.has_value());
    EXPECT_EQ(save_bytes(copy), save_bytes(memory_));
    if (wanted) last_ = *wanted;
    return wanted;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  msg::TaskEvent event(std::uint8_t what, std::uint8_t goal_state = msg::kGoalRunning) const {
    msg::TaskEvent e{};
    e.goal_id = kPlannerGoalBase + memory_.goals;
    e.task = last_.task;
    e.event = what;
    e.goal_state = goal_state;
    return e;
  }
  /// The goal succeeds, or is aborted, with this event.
  void succeed(std::uint8_t what) { step({event(what, msg::kGoalSucceeded)}); }
  void abort(std::uint8_t what) { step({event(what, msg::kGoalAborted)}); }

  void see_line(bool visible, double heading_rad = 0.0) {
    line_ = {};
    line_.visible = visible;
    line_.colour = msg::kColourBlue;
    line_.lookahead_m = 0.35;
    line_.offset_m = visible ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    line_.heading_rad = heading_rad;
  }
  void see(std::uint8_t colour, std::uint8_t kind, double range_m) {
    objects_ = {};
    objects_.blob_count = 1;
    objects_.blobs[0].colour = colour;
    objects_.blobs[0].kind = kind;
    objects_.blobs[0].object_probability = kind == msg::kBlobObject ? 0.99 : 0.01;
    objects_.blobs[0].range_m = range_m;
  }
  /// Sees the zone of this colour straight ahead; the map knows it.
  void see_zone(std::uint8_t colour, double range_m) {
    see(colour, msg::kBlobZone, range_m);
    if (zone_of(map_, colour)) return;
    const double x_m = pose_.x_m + range_m * std::cos(pose_.yaw_rad),
                 y_m = pose_.y_m + range_m * std::sin(pose_.yaw_rad);
    map_.objects[map_.object_count++] = {1, colour, msg::kBlobZone, x_m, y_m, 0.4, 0.0, 0.03, false, false, tick_, 0.0};
  }
  void see_nothing() {
    objects_ = {};
    see_line(false);
  }
  /// Turns head and body to this heading, or each to its own: a body that points elsewhere is curled up.
  void face(double yaw_rad) { face(yaw_rad, yaw_rad); }
  void face(double yaw_rad, double body_yaw_rad) {
    pose_.yaw_rad = wrap_angle(yaw_rad);
    pose_.body_yaw_rad = wrap_angle(body_yaw_rad);
  }
  /// Drives `metres` along the head's heading, with the line, which runs along x, in view.
  void drive(double metres) {
    see_line(true);
    for (int i = 0; i < 150; ++i) {
      pose_.x_m += metres / 150.0 * std::cos(pose_.yaw_rad);
      pose_.y_m += metres / 150.0 * std::sin(pose_.yaw_rad);
      step();
    }
  }
  /// Turns in the requested direction at 1 rad/s until the state changes, by one revolution at most.
  void turn() {
    const MissionState from = memory_.state;
    for (int i = 0; i < 315 && memory_.state == from; ++i) {
      face(pose_.yaw_rad + (last_.parameters.direction == msg::kDirectionLeft ? 0.02 : -0.02));
      step();
    }
  }
  void find_line() {
    if (memory_.state == MissionState::kTurnRound) {
      see_line(true);
      turn();
      face(0.0);
    }
    see_line(true);
    steps(4);
    EXPECT_EQ(memory_.state, MissionState::kFollowLine);
  }
  /// From the line to the object in the U; then the head faces back.
  void fetch(std::uint8_t colour) {
    drive(4.0);
    see(colour, msg::kBlobObject, 1.2);
    steps(4);
    EXPECT_EQ(memory_.state, MissionState::kTrackObject);
    EXPECT_EQ(last_.parameters.object_colour, colour);
    succeed(msg::kEventObjectReached);
    EXPECT_EQ(memory_.state, MissionState::kPregrasp);
    succeed(msg::kEventObjectPregrasped);
    EXPECT_EQ(memory_.state, MissionState::kGrasp);
    see_nothing();
    status_.carrying = true;
    face(std::numbers::pi);
    succeed(msg::kEventObjectGrasped);
    EXPECT_EQ(memory_.state, MissionState::kSearchLine);
  }
  void carry() {
    see_line(true);
    steps(4);
    EXPECT_EQ(memory_.state, MissionState::kTransport);
    EXPECT_EQ(last_.task, msg::kTaskFollowLine);
    drive(4.0);
  }
  /// The map shows an object of this colour `offset_m` from the centre of its zone, of 0.4 m radius. Both places have
  /// this standard deviation; the object was seen in this tick.
  void map_dropped(std::uint8_t colour, double offset_m, double sd_m = 0.03) {
    map_.object_count = 2;
    map_.objects[0] = {1, colour, msg::kBlobZone, pose_.x_m, pose_.y_m, 0.4, 0.0, sd_m, false, false, tick_, 0.0};
    map_.objects[1] = {
        object_, colour, msg::kBlobObject, pose_.x_m + offset_m, pose_.y_m, 0.08, 0.15, sd_m, false, false, tick_, 1.0};
  }
  /// Drops the object until the robot has backed off, and says nothing of where it stands.
  void release(std::uint8_t colour) {
    see_zone(colour, 0.8);
    steps(4);
    EXPECT_EQ(memory_.state, MissionState::kDrop);
    EXPECT_EQ(last_.task, msg::kTaskDrop);
    EXPECT_EQ(last_.parameters.drop_zone_colour, colour);
    see_nothing();
    status_.carrying = false;
    steps(200);  // the robot backs off
    EXPECT_EQ(memory_.state, MissionState::kDrop);
  }
  /// Drops the object, which the robot then sees in the middle of its zone.
  void drop(std::uint8_t colour) {
    release(colour);
    map_dropped(colour, 0.1);
    succeed(msg::kEventDroppingDone);
    // After the last object the robot looks a little longer.
    for (int i = 0; i < 60 && memory_.state == MissionState::kInspect; ++i) {
      map_dropped(colour, 0.1);
      step();
    }
  }

  /// After the last drop the robot looks once more at the object that it delivered first, which it names by `handle`;
  /// it then lies `offset_m` from the centre of its zone. `map_both`: maps both objects, with the offset and the
  /// standard deviation of the first one.
  template <class MapBoth>
  void expect_second_look(double uncertain_m, double offset_m, std::uint16_t handle, const MapBoth& map_both) {
    for (int i = 0; i < 70 && memory_.object_index == 1; ++i) {
      map_both(uncertain_m, 0.2);
      step();
    }
    ASSERT_EQ(memory_.state, MissionState::kInspect);
    EXPECT_EQ(memory_.delivered, 2u);
    map_both(uncertain_m, 0.2);
    step();
    EXPECT_EQ(last_.parameters.object_handle, handle) << "another object in view proves nothing";
    EXPECT_EQ(last_.parameters.object_colour, config_.sequence[0]);
    for (int i = 0; i < 200 && memory_.state == MissionState::kInspect; ++i) {
      map_both(offset_m, 0.03);
      step();
    }
    EXPECT_EQ(memory_.state, offset_m < 0.4 ? MissionState::kDone : MissionState::kSearchObject) << offset_m;
    EXPECT_EQ(memory_.delivered, offset_m < 0.4 ? 3u : 2u);
  }

  PlannerConfig config_;
  MissionMemory memory_;
  msg::LinePercept line_{};
  msg::ObjectPercepts objects_{};
  msg::RobotPose pose_{};
  msg::FieldMap map_{};
  msg::TaskStatus status_{};
  msg::Authority authority_{};
  std::uint16_t object_ = 2;  ///< handle of the dropped object
  std::vector<std::uint64_t> taken_;
  bool with_status_ = true;
  bool images_ = true;  ///< each step has the percepts of a new image
  WantedTask last_;
  double time_s_ = 0.0;
  std::int64_t tick_ = 0;
};

}  // namespace constrictor
