// Draws a Scene in software (OSMesa, OpenGL 3.3 core). The bytes of an image do not depend on run, thread count or
// context.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/render/scene.hpp"

namespace constrictor {

struct RenderOptions {
  int samples = 1;            ///< samples of a pixel: 1 (no multisampling) or 4
  int shadow_map_size = 512;  ///< [texel] edge of the shadow map; 0: no shadows
  int shadow_taps = 1;        ///< 1, or 3 for softer edges of shadows (3 x 3 lookups)
  int module_segments = 16;   ///< facets around a module
  std::optional<Eigen::Vector3d>
      head_camera_m;             ///< [m] p_HC: if given, a small camera is drawn at this point of the head
  bool draw_everything = false;  ///< also what cannot change the image: the same bytes in more time; for tests
};

/// The disc on the ground that the shadow map covers. Points outside it are fully lit.
struct ShadowRegion {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double radius_m = 3.0;
  bool coarse = false;  ///< the shadow map has half of RenderOptions::shadow_map_size: for small images
};

/// Draws one scene. The first frame takes some tenths of a second if the shaders are not in the cache. A frame is a
/// pure function of scene, options, poses, camera and region. Throws std::runtime_error if OpenGL fails.
class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Returns RGB8 rows from the top, width * height * 3 bytes, valid until the next call.
  const std::vector<std::uint8_t>& draw(const ScenePoses& poses, const PinholeCamera& camera,
                                        const ShadowRegion& region);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace constrictor
