// What the contacts with obstacles do to the motion of the body.
#pragma once

#include "constrictor/messages.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor {

/// The effect of all obstacles that the body touches. Contacts with the ground are no part of it.
struct ObstacleEffect {
  double forward_n = 0.0;  ///< sum of their forces on the body, along the course; positive: they propel it
  /// -1 to 1: where the head can slide off an obstacle that stops it; positive left, 0 if nothing stops it
  double way_out = 0.0;
};

/// `heading_rad`: of each link, relative to the course. Forces below 0.5 N count as noise. A contact stops the head if
/// it is on one of the first two modules and presses them backwards by more than 0.3 of its force; the obstacle is then
/// on the side from which it presses, and the way out on the other side. Forces include the friction on the obstacle.
[[nodiscard]] ObstacleEffect obstacle_effect(const msg::ContactState& felt, const YawChain& chain,
                                             const LinkArray& heading_rad);

}  // namespace constrictor
