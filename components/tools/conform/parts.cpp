#include "conform/parts.hpp"

#include <stdexcept>

#include "conform/camera_conformance.hpp"
#include "conform/control_conformance.hpp"
#include "conform/perception_conformance.hpp"
#include "conform/planner_conformance.hpp"

namespace constrictor::conform {
namespace {

template <class Profile, class Conformance>
void run(PartPort& port, const PartSetting& setting, Report& report) {
  const auto profile = load_parameters<Profile>(setting.profile);
  Conformance(port, setting.robot, profile, report).run();
}

void run_planner(PartPort& port, const PartSetting& setting, Report& report) {
  const auto profile = load_parameters<PlannerProfile>(setting.profile);
  PlannerConformance(port, mission_of(setting.mission), profile, report).run();
}

void run_camera(PartPort& port, const PartSetting& setting, Report& report) {
  auto profile = load_parameters<CameraProfile>(setting.profile);
  if (profile.colour == msg::kColourUnknown && !setting.mission.empty())
    profile.colour = mission_of(setting.mission).line_colour;
  CameraConformance(port, setting.robot, profile, setting.may_move, report).run();
}

}  // namespace

const std::vector<PartKind>& part_kinds() {
  static const std::vector<PartKind> kinds = {
      {"control", "check a control: methods, directions, limits, silence, authority, stops",
       "Plays the plant, navigation and the input layer around the control; no real joint moves.", control_checks,
       describe_parameters<ControlProfile>, run<ControlProfile, ControlConformance>, false, false},
      {"perception", "check a perception: line, objects, colours, frames, stamps, refusals",
       "Shows the perception images whose content is known, and plays navigation; no real camera is used.",
       perception_checks, describe_parameters<PerceptionProfile>, run<PerceptionProfile, PerceptionConformance>, false,
       false},
      {"planner", "check a planner: a whole mission, lost and refused requests, authority, stops",
       "Plays the mission of the manifest's scenario: percepts, map, navigation and the input layer; nothing moves.",
       planner_checks, describe_parameters<PlannerProfile>, run_planner, false, false},
      {"camera", "check a camera: model, sizes, rate, stamps, colours, and how the scene moves with the head",
       "This turns the head to the left and lifts the nose, slowly. Lay the robot on flat ground, with the line ahead, "
       "and keep a hand at\nthe power switch.",
       camera_checks, describe_parameters<CameraProfile>, run_camera, true, true},
  };
  return kinds;
}

const PartKind& part_kind(const std::string& name) {
  for (const PartKind& kind : part_kinds()) {
    if (name == kind.name) return kind;
  }
  throw std::invalid_argument("conform: no part is named " + name);
}

}  // namespace constrictor::conform
