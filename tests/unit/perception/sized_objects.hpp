// Attitudes of the camera, and what tests of sizes ask of percepts.
#pragma once

#include <cstdint>
#include <string>

#include "lit_scene.hpp"

namespace constrictor::testing {

/// The camera is 0.085 m above the ground.
inline const Conditions kAttitudes[] = {
    {1.0, 0.35, 0.0, false, {}},
    {0.5, 0.35, 0.03, false, {0.0, 0.02, 0.4, 0.035}},
    {1.5, 0.3, 0.05, false, {0.03, -0.02, -2.0, 0.035}},
    {0.7, 0.4, 0.03, false, {-0.04, 0.04, 1.0, 0.035}},
};

inline const msg::Blob* find(const perception::Percepts& percepts, std::uint8_t kind) {
  for (int i = 0; i < percepts.objects.blob_count; ++i) {
    if (percepts.objects.blobs[i].kind == kind) return &percepts.objects.blobs[i];
  }
  return nullptr;
}

inline std::string describe(const Conditions& c, double radius_m, double height_m, double range_m) {
  return "intensity " + std::to_string(c.intensity) + ", radius " + std::to_string(radius_m) + ", height " +
         std::to_string(height_m) + ", range " + std::to_string(range_m);
}

}  // namespace constrictor::testing
