#include "planner/attempts.hpp"

#include <array>
#include <cstddef>

namespace constrictor {

Way next_way(const Attempts& attempts) {
  struct Size {
    double clearance_m, wrap_scale;
  };
  // First nearer, because most attempts fail without a touch, and wider, because a wide U takes the object in easily.
  constexpr std::array kSizes = {Size{0.0, 0.0}, Size{0.02, 1.15}, Size{0.10, 0.9}, Size{0.02, 0.9}, Size{0.10, 1.15}};
  Way way;
  if (attempts.failures <= 0) return way;
  if (attempts.side == msg::kDirectionLeft) way.direction = msg::kDirectionRight;
  if (attempts.side == msg::kDirectionRight) way.direction = msg::kDirectionLeft;
  const Size& size = kSizes[static_cast<std::size_t>(attempts.failures / 2) % kSizes.size()];
  way.clearance_m = size.clearance_m;
  way.wrap_scale = size.wrap_scale;
  return way;
}

std::uint8_t next_departure(const Attempts& attempts) {
  constexpr std::array kDirections = {msg::kDirectionLeft, msg::kDirectionRight, msg::kDirectionBackwards};
  return kDirections[static_cast<std::size_t>(attempts.failures) % kDirections.size()];
}

}  // namespace constrictor
