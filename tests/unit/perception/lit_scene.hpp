// Percepts of ray-cast scenes under several lights and attitudes of the head.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>

#include "perception/line_and_blob_detector.hpp"
#include "ray_caster.hpp"

namespace constrictor::testing {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// How a scene is lit and how the head is held: the conditions under which each claim must hold.
struct Conditions {
  double intensity, ambient, noise_sd;
  bool gamma;
  Head head;
};

/// What the detector finds in the scene. The line's colour is blue.
inline perception::Percepts look(Scene scene, const Conditions& c, std::uint64_t seed = 1,
                                 const perception::ObjectSizes& sizes = {}) {
  static perception::LineAndBlobDetector detector{perception::PerceptionConfig{}};
  scene.light_intensity = c.intensity;
  scene.ambient = c.ambient;
  scene.noise_sd = c.noise_sd;
  scene.gamma = c.gamma;
  scene.seed = seed;
  const msg::CameraInfo info = camera_info();
  const perception::GroundCamera camera(info, orientation(c.head), c.head.height_m);
  return detector.detect(draw(scene, info, c.head), camera, msg::kColourBlue, sizes);
}

/// The first object or zone of that colour; null if there is none. Valid as long as the percepts.
inline const msg::Blob* find(const perception::Percepts& percepts, std::uint8_t colour, std::uint8_t kind) {
  for (int i = 0; i < percepts.objects.blob_count; ++i) {
    const msg::Blob& blob = percepts.objects.blobs[i];
    if (blob.colour == colour && blob.kind == kind) return &blob;
  }
  return nullptr;
}

inline std::string describe(const Conditions& c) {
  return "intensity " + std::to_string(c.intensity) + ", noise " + std::to_string(c.noise_sd) + ", gamma " +
         std::to_string(c.gamma) + ", roll " + std::to_string(c.head.roll_rad) + ", pitch " +
         std::to_string(c.head.pitch_rad);
}

}  // namespace constrictor::testing
