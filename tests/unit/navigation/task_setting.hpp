// What the tests of single tasks need to call one: the robot, navigation's configuration, and the inputs of a step.
#pragma once

#include <vector>

#include "component/data_path.hpp"
#include "navigation/task.hpp"

namespace constrictor {

/// The inputs of a task, which a test changes as it likes. The robot is `mamba`.
struct TaskSetting {
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  NavigationConfig config;
  GripSense sense{robot, config.grip};
  Tick tick;
  msg::TaskParameters parameters{};
  ObjectTrackerState sightings;
  msg::FieldMap map{};
  msg::JointState joints{};
  std::vector<PlanarPose> body;
  std::vector<Touch> touches;
  double sway_period_s = 1.0;

  TaskSetting() { tick.period_ns = 20'000'000; }
  /// The inputs with the head at `X_MH` and an image of the line, if there is a new one. They refer to this setting.
  [[nodiscard]] TaskInput input(const PlanarPose& X_MH = {}, const msg::LinePercept* line = nullptr) const {
    return {tick,      robot, config, sense, parameters, X_MH, line, false,
            sightings, &map,  joints, body,  touches,    true, true, sway_period_s};
  }
  void next_tick() {
    ++tick.index;
    tick.time_ns += tick.period_ns;
  }
};

}  // namespace constrictor
