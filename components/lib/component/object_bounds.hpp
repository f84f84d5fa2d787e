// What `--check` asks components, to find out before the start whether the robot can hold the objects that the mission
// demands. Nothing of this reaches a component of the robot during a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace constrictor {

/// An object that the mission demands, as the scene has it.
struct DemandedObject {
  std::string key;  ///< of its size in the scenario, for people
  /// [m] of the largest circle in its footprint. A narrower U cannot hold it, whichever way it turns.
  double radius_m = 0.0;
};

/// A component that knows the true scene.
class ObjectSource {
 public:
  virtual ~ObjectSource() = default;
  /// The largest object of these colours (msg::kColour…); nothing if there is none.
  [[nodiscard]] virtual std::optional<DemandedObject> largest_object(
      const std::vector<std::uint8_t>& colours) const = 0;
};

/// A component that lets the robot hold objects.
class ObjectHolder {
 public:
  virtual ~ObjectHolder() = default;
  /// [m] radius of the largest object that the body can hold.
  [[nodiscard]] virtual double largest_radius_m() const = 0;
};

}  // namespace constrictor
