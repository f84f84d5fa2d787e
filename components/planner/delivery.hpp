// Whether a dropped object stands on its zone, as far as the robot's map shows it.
#pragma once

#include <cstdint>

#include "constrictor/messages.hpp"

namespace constrictor {

enum class Delivery : std::uint8_t {
  kUnseen,     ///< no image has shown the object, or its zone, since the drop
  kUncertain,  ///< seen, but the uncertainty of the map spans the border of the zone
  kOnZone,
  kOutside,
};

/// A dropped object and the nearest zone of its colour.
struct DeliveryView {
  Delivery verdict = Delivery::kUnseen;
  double offset_m = 0.0;  ///< between the centres of object and zone; NaN: one of them is not in the map
  double radius_m = 0.0;  ///< of the zone
};

/// Compares the object's place with the nearest zone of its colour. The object is the landmark with `handle` (0, or a
/// handle that the map does not have: the object of the colour that was seen last). It counts as seen if an image after
/// `released_tick` shows it. The standard deviations of both places are taken into account: the verdict is kOnZone if
/// the object's centre lies inside the zone by one standard deviation, kOutside if it lies outside by one.
/// `zone_radius_m`: of a zone whose radius the map does not know.
[[nodiscard]] DeliveryView view_delivery(const msg::FieldMap& map, std::uint8_t colour, std::uint16_t handle,
                                         std::int64_t released_tick, double zone_radius_m);

}  // namespace constrictor
