// What `--check` asks components, to find out before the start whether the scene hinders the mission, and whether the
// robot can retrieve the objects that the mission demands. Nothing of this reaches a component of the robot during a
// run.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "component/check_verdict.hpp"

namespace constrictor {

/// An object that the mission demands, as the scene has it.
struct DemandedObject {
  std::string key;  ///< in the scenario, for people: "objects[1]"
  bool box = false;
  double width_m = 0.0;   ///< shorter side of the footprint; of a cylinder its diameter
  double length_m = 0.0;  ///< longer side; of a cylinder its diameter
  double height_m = 0.0;
  std::string zone_key;        ///< of the largest zone of its colour: "zones[0]"
  double zone_radius_m = 0.0;  ///< of this zone

  /// [m] of the smallest circle round the footprint.
  [[nodiscard]] double radius_m() const { return box ? 0.5 * std::hypot(width_m, length_m) : 0.5 * width_m; }
  /// The key of its size: "objects[1].radius_m".
  [[nodiscard]] std::string size_key() const { return key + (box ? ".size_m" : ".radius_m"); }
  /// The key of its height: "objects[1].height_m".
  [[nodiscard]] std::string height_key() const { return key + (box ? ".size_m" : ".height_m"); }
};

/// A component that knows the true scene.
class ObjectSource {
 public:
  virtual ~ObjectSource() = default;
  /// The objects of these colours (msg::kColour…).
  [[nodiscard]] virtual std::vector<DemandedObject> demanded_objects(
      const std::vector<std::uint8_t>& colours) const = 0;
};

/// A component that knows the true scene, and finds what hinders the mission in it.
class SceneJudge {
 public:
  virtual ~SceneJudge() = default;
  [[nodiscard]] virtual CheckVerdict judge_scene() const = 0;
};

/// A component that knows which objects it can deal with.
class ObjectJudge {
 public:
  virtual ~ObjectJudge() = default;
  [[nodiscard]] virtual CheckVerdict judge(const DemandedObject& object) const = 0;
};

}  // namespace constrictor
