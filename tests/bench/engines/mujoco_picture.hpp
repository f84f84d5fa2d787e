// MuJoCo's renderer (mjr_ functions), drawing into memory with OSMesa a scene like that of sim/render.
#pragma once

#include <GL/osmesa.h>

#include <cstdint>
#include <vector>

#include "sim/render/renderer.hpp"
#include "support/mujoco_model.hpp"

namespace constrictor {

/// Line and zones are painted into the texture of the ground, which is the same for each image; bodies, camera, light
/// and the region of the shadow map are those of the scene. Does not include gloss and obstacles.
class MujocoPicture {
 public:
  /// `shadow_map_size` [texel]: 0: no shadows. Throws std::runtime_error if OSMesa or MuJoCo cannot draw; the message
  /// says which call failed.
  MujocoPicture(const Scene& scene, const ScenePoses& poses, const PinholeCamera& camera, const ShadowRegion& region,
                int shadow_map_size);
  ~MujocoPicture();
  MujocoPicture(const MujocoPicture&) = delete;
  MujocoPicture& operator=(const MujocoPicture&) = delete;

  /// Draws the image and reads it. Returns RGB8 rows from the bottom, valid until the next call.
  const std::vector<std::uint8_t>& draw();

 private:
  void make_context();

  testing::MujocoModel model_;
  testing::MujocoData data_;
  mjrRect view_{};
  OSMesaContext context_ = nullptr;
  std::vector<std::uint8_t> window_;
  std::vector<std::uint8_t> rgb_;
  mjvScene scene_{};
  mjvCamera camera_{};
  mjvOption options_{};
  mjrContext renderer_{};
};

}  // namespace constrictor
