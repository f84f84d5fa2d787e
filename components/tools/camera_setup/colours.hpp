// The colours of line, objects and zones as a camera shows them.
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace constrictor::camera_setup {

/// Pixels of one colour, from one or several pictures.
class ColourSample {
 public:
  /// Adds the pixels of `box`, which must lie inside of the picture.
  void add(const cv::Mat& bgr, const cv::Rect& box);

  struct Statistics {
    double hue_deg = 0.0;             ///< mean (0 red, 120 green, 240 blue)
    double spread_deg = 0.0;          ///< 98 % of the pixels are at most so far from the mean
    double chroma = 0.0;              ///< 2 % of the pixels have less: difference of the channels (full scale: 1)
    double saturation = 0.0;          ///< 2 % of the pixels have less: that difference by the largest channel
    double highest_chroma = 0.0;      ///< 2 % of the pixels have more
    double highest_saturation = 0.0;  ///< 2 % of the pixels have more
    std::size_t pixels = 0;
  };
  [[nodiscard]] Statistics statistics() const;

 private:
  std::vector<cv::Vec3b> pixels_;
};

/// The parameters with which perception distinguishes the colours: lines of its configuration file, and warnings.
struct ColourResult {
  std::string yaml;
  std::vector<std::string> warnings;
};

/// `samples`: by the name of the colour in the IDL; the name `ground` stands for everything that has no such colour.
/// Throws std::invalid_argument if a sample of a colour is grey or shows several hues, or if two colours, or a colour
/// and the ground, cannot be distinguished.
[[nodiscard]] ColourResult teach_colours(const std::map<std::string, ColourSample>& samples);

}  // namespace constrictor::camera_setup
