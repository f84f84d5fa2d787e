// Whether a dropped object stands on its zone, as far as the robot's map shows it.
#pragma once

#include <cstdint>
#include <vector>

#include "component/object_bounds.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

enum class Delivery : std::uint8_t {
  kUnseen,     ///< no image has shown the object, or its zone, since the drop
  kUncertain,  ///< seen, but the map is too uncertain, or its uncertainty spans the border of the zone
  kOnZone,
  kOutside,
};

/// A dropped object and the zone of its colour.
struct DeliveryView {
  Delivery verdict = Delivery::kUnseen;
  bool precise = false;      ///< the standard deviation of the object's place is at most `seen_sd_m`
  double offset_m = 0.0;     ///< between the centres of object and zone; NaN: one of them is not in the map
  double radius_m = 0.0;     ///< of the zone
  std::uint16_t handle = 0;  ///< of the object's landmark; 0: none was seen
  double sd_m = 0.0;         ///< standard deviation of the offset, without what the places have in common

  /// Whether the object's centre lies inside the zone by this length [m], and by kRim_m for what the standard
  /// deviations do not contain, such as the error of the zone's radius.
  [[nodiscard]] bool probably_inside(double by_m = 0.0) const { return offset_m + by_m <= radius_m - kRim_m; }
  static constexpr double kRim_m = 0.03;
};

/// Which object was dropped, and what counts as having seen it.
struct DroppedObject {
  std::uint8_t colour = msg::kColourUnknown;
  std::uint16_t handle = 0;  ///< of the object; 0: unknown
  /// Highest handle of the map at the release. The map gives the object a new, higher handle if it is seen too far from
  /// where the robot let it go.
  std::uint16_t newest_handle = 0;
  std::int64_t released_tick = -1;  ///< last tick in which the body held the object, or left it
  /// True: the robot may have pushed the object away from the place where the map still has it. Two rules then change.
  /// If several landmarks may be the object and have a certain verdict, the one that was seen last counts. A landmark
  /// that lies outside its zone by three standard deviations is kOutside, even if its place is imprecise.
  bool may_have_moved = false;
  std::vector<std::uint16_t> others{};  ///< handles of other objects of this colour, which it is not
};

/// Compares the object's place with the zone of its colour. It counts as seen if an image after `released_tick` shows
/// it. If the standard deviation of its place is more than `seen_sd_m` [m], the verdict is kUncertain: a part of an
/// object at the image's border does not show where its centre is. Of several landmarks that may be the object, the
/// most precise one counts, unless the object may have moved; without a handle, every object of the colour may be it.
/// The standard deviations of object and zone are taken into account: the verdict is kOnZone if the object's centre
/// lies inside the zone by one standard deviation and kRim_m, kOutside if it lies outside by one standard deviation.
/// `zone_radius_m`: [m] radius of a zone whose radius the map does not know.
[[nodiscard]] DeliveryView view_delivery(const msg::FieldMap& map, const DroppedObject& dropped, double seen_sd_m,
                                         double zone_radius_m);

/// Whether as many objects of the dropped one's colour stand on their zone as were delivered with it, of which an image
/// after `released_tick` shows at least one. Objects of one colour that stand side by side hide each other, and the map
/// may take one for the other, so that it has no new image of the one that was dropped.
[[nodiscard]] bool all_on_zone(const msg::FieldMap& map, const DroppedObject& dropped, double seen_sd_m,
                               double zone_radius_m);

/// Whether the zone of this object is large enough to see that the object was delivered: at least as large as the
/// object, which would hide it, and larger than what the map may be wrong by.
[[nodiscard]] CheckVerdict judge_zone_size(const DemandedObject& object);

/// The highest handle in the map; 0 if it is empty.
[[nodiscard]] std::uint16_t newest_handle(const msg::FieldMap& map);

}  // namespace constrictor
