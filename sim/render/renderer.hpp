// Draws a Scene in software (OSMesa, OpenGL 3.3 core): the same bytes on every run, thread count and context.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/render/scene.hpp"

namespace constrictor {

struct RenderOptions {
  int samples = 1;              ///< of multisampling: 1 (off) or 4
  int shadow_map_size = 512;    ///< [texel] edge; 0: no shadows
  int shadow_taps = 1;          ///< 1, or 3 for softer edges (3 x 3)
  int module_segments = 16;     ///< around a module
  std::optional<Eigen::Vector3d> head_camera_m;  ///< if given, a small camera housing is drawn there in the head's frame
};

/// What the shadow map covers: a disc on the ground. Things outside are fully lit.
struct ShadowRegion {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double radius_m = 3.0;
};

/// A renderer of one scene. Building it takes some tenths of a second (shader compilation happens in the first frame);
/// a frame is a pure function of scene, options, poses, camera and region. Throws std::runtime_error if OpenGL fails.
class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Returns RGB8 rows from the top, width * height * 3 bytes, valid until the next call.
  const std::vector<std::uint8_t>& draw(const ScenePoses& poses, const PinholeCamera& camera, const ShadowRegion& region);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace constrictor
