// A robot that receives tasks and nothing else, in a world of the test's own: physics, rendered camera, perception,
// guidance, navigation and control in one process. The tests compare navigation's events with ground truth, which the
// robot does not know.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "control/control.hpp"
#include "guidance/guidance.hpp"
#include "navigation/navigation.hpp"
#include "perception/perception.hpp"
#include "robot/planar_message.hpp"
#include "sim/camera/camera.hpp"
#include "sim/physics/physics.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

/// A position on the ground with a heading, in W.
struct Place {
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  [[nodiscard]] double distance_m(const Place& other) const { return std::hypot(other.x_m - x_m, other.y_m - y_m); }
  /// [rad] bearing of another place, positive left.
  [[nodiscard]] double bearing_rad(const Place& other) const {
    return wrap_angle(std::atan2(other.y_m - y_m, other.x_m - x_m) - yaw_rad);
  }
};

inline Place place_of(const msg::Pose3& pose) {
  const PlanarPose X_W = planar(pose);
  return {X_W.p.x(), X_W.p.y(), X_W.yaw_rad};
}

class Behaviour : public ::testing::Test {
 protected:
  /// An event with the ground truth at that moment.
  struct Happened {
    double time_s = 0.0;
    msg::TaskEvent event{};
    Place head, object;
  };

  /// Begins a run in this world (the text of a scenario file). If `from` is not empty, the run uses navigation.yaml
  /// with the text `from` replaced by `to`.
  void begin(const std::string& world, const std::string& from = "", const std::string& to = "") {
    constrictor::Setup setup;
    setup.robot_file = data_path("components/lib/robot/" + robot_ + ".yaml");
    setup.scenario_file = dir_ / "scenario.yaml";
    setup.seed = 1;
    std::ofstream(setup.scenario_file) << world;
    std::map<std::string, std::filesystem::path> config_files;
    if (!from.empty()) {
      std::ifstream file(data_path("components/navigation/navigation.yaml"));
      std::string text{std::istreambuf_iterator<char>(file), {}};
      ASSERT_NE(text.find(from), std::string::npos) << from;
      std::ofstream(dir_ / "navigation.yaml") << text.replace(text.find(from), from.size(), to);
      config_files["navigation"] = dir_ / "navigation.yaml";
    }
    run_ = std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{make_physics_factory(), make_camera_factory(), make_perception_factory(),
                                      make_guidance_factory(), make_navigation_factory(), make_control_factory(),
                                      scripted_writer<msg::TaskCommand>("input", topics::kTaskCommand,
                                                                        [queue = queue_](const Tick&, const auto& out) {
                                                                          for (; !queue->empty(); queue->pop_front())
                                                                            out.write(queue->front());
                                                                        })},
        setup, config_files);
    run_->subscribe<msg::TaskEvent>(topics::kTaskEvent, [this](const msg::TaskEvent& event) {
      happened.push_back({run_->time_s(), event, head(), object_count() > 0 ? object() : Place{}});
      std::printf("%7.2f s  task %u event %u goal state %u %s\n", run_->time_s(), event.task, event.event,
                  event.goal_state, event.detail);
    });
    run_->subscribe<msg::TouchedState>(topics::kTouchedState, [this](const msg::TouchedState& touched) {
      for (int i = 0; i < touched.contact_count; ++i) {
        if (touched.kind[i] == msg::kTouchedObject) object_touched_s = run_->time_s();
      }
    });
    run_->advance(2);  // until the first messages have been written
  }

  /// Starts a task and returns its goal id.
  std::uint64_t start(std::uint8_t task, const std::function<void(msg::TaskParameters&)>& parameters) {
    msg::TaskCommand command{};
    command.goal_id = ++goal_;
    command.task = task;
    command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
    parameters(command.parameters);
    queue_->push_back(command);
    return goal_;
  }
  std::uint64_t start(std::uint8_t task, std::uint8_t msg::TaskParameters::*parameter, std::uint8_t value) {
    return start(task, [&](msg::TaskParameters& p) { p.*parameter = value; });
  }
  /// Starts a task for the green object.
  void start_green(std::uint8_t task) { start(task, &msg::TaskParameters::object_colour, msg::kColourGreen); }

  /// Advances until `condition` is true. Returns false if that takes longer than `bound_s` of simulated time.
  bool until(const std::function<bool()>& condition, double bound_s) {
    for (const double end_s = run_->time_s() + bound_s; run_->time_s() < end_s; run_->advance(1)) {
      if (condition()) return true;
    }
    return condition();
  }
  bool until_event(std::uint8_t event, double bound_s) {
    const std::size_t from = happened.size();
    return until([&] { return first(event, from) != nullptr; }, bound_s);
  }
  /// Advances until the newest goal has ended, and returns its state. Returns kGoalIdle if the goal is still running
  /// after `bound_s` of simulated time.
  std::uint8_t until_end(double bound_s) {
    const auto ended = [&]() -> std::uint8_t {
      for (const auto& h : happened) {
        if (h.event.goal_id == goal_ && h.event.event == msg::kEventNone && h.event.goal_state > msg::kGoalRunning)
          return h.event.goal_state;
      }
      return msg::kGoalIdle;
    };
    until([&] { return ended() != msg::kGoalIdle; }, bound_s);
    return ended();
  }
  /// The first event of this kind from index `from` of `happened` on; null if there is no such event.
  [[nodiscard]] const Happened* first(std::uint8_t event, std::size_t from = 0) const {
    for (std::size_t i = from; i < happened.size(); ++i) {
      if (happened[i].event.event == event) return &happened[i];
    }
    return nullptr;
  }

  /// Handle of the object of this colour in guidance's map; 0 if the map has no object of this colour, or several.
  [[nodiscard]] std::uint16_t mapped_handle(std::uint8_t colour) const {
    const auto& map = *run_->latest(topics::kFieldMap);
    std::vector<std::uint16_t> handles;
    for (int i = 0; i < map.object_count; ++i) {
      if (map.objects[i].kind == msg::kBlobObject && map.objects[i].colour == colour)
        handles.push_back(map.objects[i].handle);
    }
    return handles.size() == 1 ? handles.front() : 0;
  }
  /// Handle of the object in guidance's map that is less than 0.3 m from `place`; 0 if there is no such object. The
  /// robot must have started at the origin of W, because the frame M of the map is then equal to W.
  [[nodiscard]] std::uint16_t mapped_near(const Place& place) const {
    const auto& map = *run_->latest(topics::kFieldMap);
    for (int i = 0; i < map.object_count; ++i) {
      const auto& object = map.objects[i];
      if (object.kind == msg::kBlobObject && place.distance_m({object.x_m, object.y_m}) < 0.3) return object.handle;
    }
    return 0;
  }
  [[nodiscard]] const msg::WorldState& world() const { return *run_->latest(topics::kWorldState); }
  [[nodiscard]] Place head() const { return place_of(world().module_poses[0]); }
  [[nodiscard]] Place module(std::size_t index) const { return place_of(world().module_poses[index]); }
  [[nodiscard]] int object_count() const { return world().object_count; }
  [[nodiscard]] Place object() const { return place_of(world().object_poses[0]); }
  /// [m] horizontal distance between the centres of the object and of the nearest module.
  [[nodiscard]] double nearest_module_m() const {
    double nearest_m = 1e9;
    for (std::size_t m = 0; m < world().module_count; ++m)
      nearest_m = std::min(nearest_m, module(m).distance_m(object()));
    return nearest_m;
  }
  /// Whether a point on the ground is in the camera's view and nearer than `most_m`. The camera looks ahead from above
  /// the nose with a field of view of 90 degrees.
  static bool in_view(const Place& head, const Place& point, double most_m) {
    constexpr double kCameraAhead_m = 0.06;
    const Place camera{head.x_m + kCameraAhead_m * std::cos(head.yaw_rad),
                       head.y_m + kCameraAhead_m * std::sin(head.yaw_rad), head.yaw_rad};
    return std::abs(camera.bearing_rad(point)) < 0.25 * M_PI && camera.distance_m(point) < most_m;
  }
  /// [m] distance from the head to the nearest line point in the camera's view; infinite if no point is in view.
  [[nodiscard]] double line_in_view_m() const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Place& point : line()) {
      if (in_view(head(), point, 100.0)) nearest_m = std::min(nearest_m, head().distance_m(point));
    }
    return nearest_m;
  }
  [[nodiscard]] std::vector<Place> line() const {
    const auto& scene = *run_->latest(topics::kSceneDescription);
    std::vector<Place> points;
    for (int i = 0; i < scene.line_point_count; ++i) points.push_back({scene.line_x_m[i], scene.line_y_m[i], 0.0});
    return points;
  }
  [[nodiscard]] double time_s() const { return run_->time_s(); }

  std::string robot_ = "mamba";  ///< robot file of the next run
  std::vector<Happened> happened;
  double object_touched_s = 0.0;  ///< time of the last contact of the object with anything
  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
  std::unique_ptr<LocalRun> run_;

 private:
  std::shared_ptr<std::deque<msg::TaskCommand>> queue_ = std::make_shared<std::deque<msg::TaskCommand>>();
  std::uint64_t goal_ = 0;
};

}  // namespace constrictor::testing
