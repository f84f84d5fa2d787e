// Brightness pattern of the ground: concrete-like noise with faint joints every metre.
#pragma once

#include <cstdint>
#include <vector>

namespace constrictor {

inline constexpr int kGroundTextureSize = 1024;
inline constexpr double kGroundTextureExtent_m = 4.0;  ///< edge of the tile; the pattern repeats without a seam

/// Row-major square of kGroundTextureSize texels; 200 means the ground's own colour, the others scale it. The same on every
/// machine: integer noise, no libm.
std::vector<std::uint8_t> make_ground_texture();

}  // namespace constrictor
