// The brightness pattern of the ground: noise like that of concrete, with faint joints every metre.
#pragma once

#include <cstdint>
#include <vector>

namespace constrictor {

inline constexpr int kGroundTextureSize = 1024;
inline constexpr double kGroundTextureExtent_m = 4.0;  ///< [m] edge of the tile; the pattern repeats without a seam

/// A row-major square of kGroundTextureSize texels. A texel of 200 leaves the colour of the ground as it is; others
/// scale it by texel / 200. The texels are the same on every machine: the noise uses integers and not libm.
std::vector<std::uint8_t> make_ground_texture();

}  // namespace constrictor
