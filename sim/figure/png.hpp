// PNG files, by libpng.
#pragma once

#include <cstdint>
#include <string>

namespace constrictor {

/// The bytes of a PNG file that shows width * height pixels, 8 bits, red first, in rows from the top without gaps.
/// Throws std::runtime_error if libpng fails; the image must not be empty.
[[nodiscard]] std::string encode_png(int width, int height, const std::uint8_t* rgb);

}  // namespace constrictor
