// PNG files, by libpng. OpenCV's own module for image files is not used: it needs 72 more packages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

namespace constrictor::report {

/// The bytes of a PNG file that shows `bgr` (8 bits, 3 channels, blue first). Throws std::runtime_error if libpng
/// fails; the image must not be empty.
[[nodiscard]] std::string encode_png(const cv::Mat& bgr);

/// The same for `width` * `height` pixels with red first, in rows from the top without gaps.
[[nodiscard]] std::string encode_png(int width, int height, const std::uint8_t* rgb);

/// Reads a PNG file (8 bits, 3 channels, blue first). Returns an empty image if the file is missing or not a PNG file.
[[nodiscard]] cv::Mat read_png(const std::filesystem::path& file);

}  // namespace constrictor::report
