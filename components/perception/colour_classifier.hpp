// Assigns one of the known colours to each pixel, independently of the strength of the light.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "perception/perception_config.hpp"

namespace constrictor::perception {

/// Number of the pixels of one colour, and the inclusive bounds around them; u_min > u_max: there are none.
struct ColourExtent {
  int pixels = 0;
  int u_min = 1 << 30, v_min = 1 << 30, u_max = -1, v_max = -1;

  void add(int u, int v) {
    ++pixels;
    u_min = std::min(u_min, u);
    u_max = std::max(u_max, u);
    v_min = std::min(v_min, v);
    v_max = std::max(v_max, v);
  }
};

/// Label of ground on which glare leaves no colour to be told.
inline constexpr std::uint8_t kDazzled = 255;

/// The label image and where its colours are.
struct Labels {
  cv::Mat image;                                          ///< CV_8UC1, kColour... of each pixel, 0: none; or kDazzled
  std::array<ColourExtent, msg::kColourCount> extents{};  ///< by colour; not of pixels without a colour
};

/// Labels pixels by their hue if their chroma and saturation are large enough. Hue and saturation change neither with
/// the strength of neutral light nor in a shadow. A minimum chroma excludes the noise of dark pixels.
class ColourClassifier {
 public:
  explicit ColourClassifier(const PerceptionConfig& config);

  /// Labels of an RGB image (CV_8UC3), which should be smoothed. The memory of `labels` is used again.
  void classify(const cv::Mat& rgb, Labels& labels) const;

  /// Colour of one pixel, 0: none.
  [[nodiscard]] std::uint8_t colour_of(std::uint8_t r, std::uint8_t g, std::uint8_t b) const {
    return table_[index(r, g, b)];
  }

  /// Colour of one pixel by its hue alone, however pale it is. 0: none.
  [[nodiscard]] std::uint8_t colour_of_hue(std::uint8_t r, std::uint8_t g, std::uint8_t b) const;

 private:
  static std::size_t index(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    return (std::size_t{r} >> 2) << 12 | (std::size_t{g} >> 2) << 6 | std::size_t{b} >> 2;
  }
  /// Whether none of kBlock successive pixels can have a colour, because their channels hardly differ.
  static constexpr int kBlock = 16;
  [[nodiscard]] bool block_is_grey(const std::uint8_t* rgb) const;

  std::array<HueRange, msg::kColourCount> hues_;
  std::uint8_t grey_spread_ = 0;     ///< a pixel whose channels do not differ by more has no colour
  std::vector<std::uint8_t> table_;  ///< indexed by the upper 6 bits of red, green and blue
};

}  // namespace constrictor::perception
