#include "control/obstacle_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

constexpr double kNoise_n = 0.5;
constexpr double kSteepest = 0.5;  // vertical part of the normal above which a contact is one with the ground
constexpr double kStops = 0.3;     // backward share of the force
constexpr int kHeadModules = 2;

}  // namespace

ObstacleEffect obstacle_effect(const msg::ContactState& felt, const YawChain& chain, const LinkArray& heading_rad) {
  ObstacleEffect effect;
  for (int i = 0; i < felt.contact_count; ++i) {
    const msg::Contact& contact = felt.contacts[i];
    const double x_n = contact.force_n.x, y_n = contact.force_n.y;
    const double force_n = std::hypot(x_n, y_n);
    if (std::abs(contact.normal.z) > kSteepest || !(force_n >= kNoise_n)) continue;
    std::size_t link = 0;
    while (link < chain.joint_count() && chain.joint_index(link) < contact.module_index) ++link;
    effect.forward_n += std::cos(heading_rad[link]) * x_n - std::sin(heading_rad[link]) * y_n;
    if (contact.module_index < kHeadModules && x_n < -kStops * force_n) effect.way_out += y_n > 0.0 ? 1.0 : -1.0;
  }
  effect.way_out = std::clamp(effect.way_out, -1.0, 1.0);
  return effect;
}

}  // namespace constrictor
