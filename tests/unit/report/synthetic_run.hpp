// A scripted mission: every member that the report reads from, without physics, vision or planning.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "component/component.hpp"
#include "support/scripted_members.hpp"

namespace constrictor::testing {

/// The values of the mission that a test may change.
struct Story {
  double offset_m = 0.07;        ///< of the head's path from the line
  double pose_error_x_m = 0.03;  ///< of guidance's estimate, in M
  double pose_error_y_m = -0.04;
  double yaw_error_rad = 0.02;
  std::uint8_t first_colour = msg::kColourGreen;  ///< the mission's order
  std::uint8_t level = msg::kAuthorityPlanner;    ///< authority of the goals to which the events belong
  double red_drop_distance_m = 0.1;               ///< from the red zone's centre; its radius is 0.3
  std::int64_t mission_end_tick = 420;
  std::uint8_t mission_end = msg::kMissionSucceeded;  ///< what the planner announces then
  std::uint16_t objects_in_mission = 2;
  std::int64_t looks_again_tick = 1'000'000;  ///< from this tick on the planner looks at its first object again
  double line_length_m = 10.0;
  bool truth = true;                        ///< whether the plant publishes ground truth
  std::int64_t torn_from_tick = 1'000'000;  ///< from this tick on images have fewer bytes than their size requires
  std::int64_t picture_period = 1;  ///< each n-th camera image is drawn by perception; 0: only those after events
  bool pictures_after_events = true;
  std::int64_t picture_delay = 3;  ///< [ticks] from the exposure of an image to the step in which it is drawn
};

constexpr double kStartX = 1.0, kStartY = 2.0, kStartYaw = 0.5;
constexpr int kModules = 8;
constexpr double kModuleLength_m = 0.089;

struct ScriptedEvent {
  std::int64_t tick;
  std::uint8_t task, event, colour;
};
inline const std::vector<ScriptedEvent>& scripted_events() {
  static const std::vector<ScriptedEvent> kEvents{
      {10, msg::kTaskSearchObject, msg::kEventLineFound, msg::kColourBlue},
      {60, msg::kTaskFollowLine, msg::kEventObjectFound, msg::kColourGreen},
      {90, msg::kTaskPregrasp, msg::kEventObjectPregrasped, msg::kColourGreen},
      {120, msg::kTaskGrasp, msg::kEventObjectGrasped, msg::kColourGreen},
      {200, msg::kTaskDrop, msg::kEventDroppingDone, msg::kColourGreen},
      {230, msg::kTaskFollowLine, msg::kEventLineLost, msg::kColourBlue},
      {260, msg::kTaskFollowLine, msg::kEventObjectFound, msg::kColourRed},
      {290, msg::kTaskPregrasp, msg::kEventObjectPregrasped, msg::kColourRed},
      {320, msg::kTaskGrasp, msg::kEventObjectGrasped, msg::kColourRed},
      {400, msg::kTaskDrop, msg::kEventDroppingDone, msg::kColourRed},
  };
  return kEvents;
}

/// Distance of the head along the line.
inline double travel_m(std::int64_t tick) { return 0.5 + 0.005 * static_cast<double>(tick); }

/// Whether perception draws the image that was exposed at a tick.
inline bool drawn(const Story& story, std::int64_t exposure_tick) {
  if (exposure_tick < 0 || exposure_tick % 5 != 0) return false;
  if (story.picture_period > 0 && exposure_tick / 5 % story.picture_period == 0) return true;
  const std::int64_t handled = exposure_tick + story.picture_delay;
  return story.pictures_after_events && std::any_of(scripted_events().begin(), scripted_events().end(), [&](auto& one) {
           const std::int64_t visible = one.tick + 1;
           return handled - 5 < visible && visible <= handled;
         });
}

class StoryPlant : public PlantBase {
 public:
  StoryPlant(Wiring& wiring, Story story)
      : story_(story),
        scene_(wiring.output(topics::kSceneDescription)),
        world_(wiring.output(topics::kWorldState)),
        joints_(wiring.output(topics::kJointState)) {}
  void sample(const Tick& tick) override {
    if (story_.truth) write_truth(tick);
    msg::JointState joints{};
    joints.joint_count = 23;
    for (int i = 0; i < 23; i += 2)
      joints.torque_nm[i] = 3.0 * std::sin(0.3 * i + 2.0 * tick.time_s()) * (tick.index > 120 ? 1.5 : 1.0);
    joints_.write(joints);
  }

 private:
  void write_truth(const Tick& tick) {
    if (tick.index == 0) write_scene();
    msg::WorldState world{};
    world.module_count = kModules;
    const double c = std::cos(kStartYaw), s = std::sin(kStartYaw);
    const auto place = [&](double along, double across) {
      return msg::Vector3{kStartX + c * along - s * across, kStartY + s * along + c * across, 0.0};
    };
    world.module_poses[0] = {place(travel_m(tick.index), 0.0),
                             {std::cos(kStartYaw / 2), 0, 0, std::sin(kStartYaw / 2)}};
    for (int i = 1; i < kModules; ++i) {
      world.module_poses[i] = world.module_poses[0];
      world.module_poses[i].position_m = place(travel_m(tick.index) - kModuleLength_m * i, 0.0);
    }
    world.object_count = 2;
    // Objects move with the head until they are dropped; then they lie in their zones.
    const auto object = [&](int i, std::int64_t dropped, double zone_y, double miss) {
      world.object_poses[i] = {
          tick.index < dropped ? place(travel_m(tick.index), 0.1) : msg::Vector3{miss, zone_y, 0.0}, {1, 0, 0, 0}};
    };
    object(0, 195, 1.0, 0.05);
    object(1, 395, -1.0, story_.red_drop_distance_m);
    world.state_hash[0] = static_cast<std::uint8_t>(tick.index & 0xFF);
    world.state_hash[31] = 0xAB;
    world_.write(world);
  }
  void write_scene() {
    const auto scene = std::make_unique<msg::SceneDescription>();
    *scene = {};
    std::snprintf(scene->scenario, sizeof scene->scenario, "story");
    scene->seed = 11;
    scene->module_radius_m = 0.035;
    scene->module_length_m = kModuleLength_m;
    scene->module_count = kModules;
    scene->light_direction = {0.0, 0.6, 0.8};
    scene->light_intensity = 1.0;
    scene->ambient_intensity = 0.4;
    scene->ground_colour = {0.45, 0.45, 0.45};
    scene->line_colour = msg::kColourBlue;
    scene->line_width_m = 0.05;
    scene->object_count = 2;
    scene->objects[0] = {msg::kColourGreen, msg::kShapeCylinder, {0.08, 0.08, 0.15}, 0.4};
    scene->objects[1] = {msg::kColourRed, msg::kShapeCylinder, {0.08, 0.08, 0.15}, 0.4};
    scene->zone_count = 2;
    scene->zones[0] = {msg::kColourGreen, 0.0, 1.0, 0.3};
    scene->zones[1] = {msg::kColourRed, 0.0, -1.0, 0.3};
    scene->line_point_count = 2;
    const double c = std::cos(kStartYaw), s = std::sin(kStartYaw);
    for (int i = 0; i < 2; ++i) {  // parallel to the path of the head
      scene->line_x_m[i] = kStartX + c * story_.line_length_m * i + s * story_.offset_m;
      scene->line_y_m[i] = kStartY + s * story_.line_length_m * i - c * story_.offset_m;
    }
    scene_.write(*scene);
  }
  Story story_;
  Output<msg::SceneDescription> scene_;
  Output<msg::WorldState> world_;
  Output<msg::JointState> joints_;
};

inline ComponentFactory scripted(std::string name, Timing timing, WireFunction wire) {
  return scripted_member(std::move(name), std::move(wire), timing);
}

/// Writes a picture whose brightness is its tick (modulo 256).
inline void write_picture(const Output<msg::CameraImage>& output, const Tick& tick, int width, int height,
                          const Story& story) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height * 3),
                                   static_cast<std::uint8_t>(tick.index & 0xFF));
  for (std::size_t i = 0; i < pixels.size(); i += 7) pixels[i] = static_cast<std::uint8_t>(i & 0xFF);
  if (tick.index >= story.torn_from_tick) pixels.resize(10);
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(width);
  image.height = static_cast<std::uint16_t>(height);
  image.exposure_tick = tick.index;
  image.data._buffer = pixels.data();
  image.data._length = image.data._maximum = static_cast<std::uint32_t>(pixels.size());
  output.write(image);
}

inline std::vector<ComponentFactory> story_members(const Story& story) {
  std::vector<ComponentFactory> members;
  members.push_back(
      {"physics", [story](Wiring& wiring, const Setup&) { return std::make_unique<StoryPlant>(wiring, story); }});
  members.push_back(scripted("guidance", {1, 1}, [story](Wiring& wiring) {
    return [story, out = wiring.output(topics::kRobotPose)](const Tick& tick) {
      msg::RobotPose pose{};
      pose.x_m = travel_m(tick.index) - travel_m(0) + story.pose_error_x_m;  // M starts at the head's first pose
      pose.y_m = story.pose_error_y_m;
      pose.yaw_rad = story.yaw_error_rad;
      out.write(pose);
    };
  }));
  members.push_back(scripted("navigation", {1, 1}, [story](Wiring& wiring) {
    return [story, status = wiring.output(topics::kTaskStatus),
            events = wiring.output(topics::kTaskEvent)](const Tick& tick) {
      msg::TaskStatus task{};
      task.carrying = (tick.index > 120 && tick.index <= 200) || (tick.index > 320 && tick.index <= 400);
      task.task = tick.index >= 20 && tick.index < 380 ? msg::kTaskFollowLine : msg::kTaskDrop;
      task.goal_state = msg::kGoalRunning;
      task.parameters.timeout_s = std::nan("");
      status.write(task);
      for (const ScriptedEvent& scripted_event : scripted_events()) {
        if (scripted_event.tick != tick.index) continue;
        msg::TaskEvent event{};
        event.goal_id = (std::uint64_t{story.level} << 48) + 1;
        event.task = scripted_event.task;
        event.event = scripted_event.event;
        event.goal_state = msg::kGoalRunning;
        event.colour = scripted_event.colour;
        events.write(event);
      }
    };
  }));
  members.push_back(scripted("planner", {1, 1}, [story](Wiring& wiring) {
    return [story, out = wiring.output(topics::kMissionStatus)](const Tick& tick) {
      msg::MissionStatus mission{};
      const bool again = tick.index >= story.looks_again_tick;
      const bool second = tick.index > 200 && !again;
      mission.outcome = tick.index >= story.mission_end_tick ? story.mission_end : msg::kMissionRunning;
      if (mission.outcome == msg::kMissionFailed)
        std::snprintf(mission.reason, sizeof mission.reason, "more than 60 recoveries");
      mission.object_count = story.objects_in_mission;
      mission.object_index = second && story.objects_in_mission > 1 ? 1 : 0;
      const std::uint8_t other = story.first_colour == msg::kColourGreen ? msg::kColourRed : msg::kColourGreen;
      mission.delivered_count = mission.outcome == msg::kMissionSucceeded ? mission.object_count : mission.object_index;
      mission.colour = second ? other : story.first_colour;
      mission.recoveries = tick.index > 230 ? 1 : 0;
      std::snprintf(mission.state, sizeof mission.state, "%s",
                    tick.index < 60 ? "follow_line"
                    : second        ? "retrieve_second"
                                    : "retrieve_first");
      out.write(mission);
    };
  }));
  members.push_back(scripted("camera", {5, 2}, [story](Wiring& wiring) {
    return [story, out = wiring.output(topics::kCameraImage)](const Tick& tick) {
      write_picture(out, tick, 64, 48, story);
    };
  }));
  members.push_back(scripted("perception", {1, 1}, [story](Wiring& wiring) {
    return [story, line = wiring.output(topics::kLinePercept),
            out = wiring.output(topics::kProcessedImage)](const Tick& tick) {
      Tick exposure = tick;
      exposure.index -= story.picture_delay;
      if (drawn(story, exposure.index)) write_picture(out, exposure, 64, 48, story);
      if (tick.index % 5 != 0) return;
      msg::LinePercept percept{};
      percept.visible = tick.index % 20 != 0;  // three of four
      for (double* value : {&percept.end_distance_m, &percept.offset_m, &percept.heading_rad, &percept.curvature_1_m,
                            &percept.near_m, &percept.far_m})
        *value = std::nan("");
      line.write(percept);
    };
  }));
  return members;
}

}  // namespace constrictor::testing
