// Assigns one of the known colours to each pixel, independently of the strength of the light.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "perception/perception_config.hpp"

namespace constrictor::perception {

/// Labels pixels by their hue if they are coloured enough. Hue and saturation change neither with the strength of
/// neutral light nor in a shadow. A minimum chroma excludes the noise of dark pixels.
class ColourClassifier {
 public:
  explicit ColourClassifier(const PerceptionConfig& config);

  /// Label image (CV_8UC1, kColour… of each pixel, 0: none) of an RGB image (CV_8UC3), which should be smoothed.
  void classify(const cv::Mat& rgb, cv::Mat& labels) const;

  /// Colour of one pixel, 0: none.
  [[nodiscard]] std::uint8_t colour_of(std::uint8_t r, std::uint8_t g, std::uint8_t b) const {
    return table_[index(r, g, b)];
  }

 private:
  static std::size_t index(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    return (std::size_t{r} >> 2) << 12 | (std::size_t{g} >> 2) << 6 | std::size_t{b} >> 2;
  }
  std::vector<std::uint8_t> table_;  ///< indexed by the upper 6 bits of red, green and blue
};

}  // namespace constrictor::perception
