// Ground that has one of the colours of interest. It is told from objects and zones of this colour by its hue and
// saturation, which change neither with the strength of the light nor in shadows.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"

namespace constrictor::perception {

/// Hue and saturation of a pixel, without its brightness: the shares of red and blue in the sum of its channels.
struct Tint {
  double red = 0.0;
  double blue = 0.0;
  /// Two tints that differ by more are told apart.
  static constexpr double kTolerance = 0.045;
  [[nodiscard]] double distance(const Tint& other) const;
  [[nodiscard]] static Tint of(const std::uint8_t* rgb);
};

/// The tints of several pixels.
class TintSamples {
 public:
  void clear();
  void add(const Tint& tint);
  /// Their median; that of no pixel is a default one. Reorders them.
  [[nodiscard]] Tint usual();

 private:
  std::vector<double> red_, blue_;
};

/// What one image, or the images so far, show of the ground.
struct GroundColour {
  std::uint8_t colour = msg::kColourUnknown;  ///< unknown: the ground has no colour of interest
  Tint tint;                                  ///< valid with a colour
  std::int32_t images = 0;  ///< how many images more have shown this ground than another one, at most kMemoryImages

  [[nodiscard]] bool coloured() const { return colour != msg::kColourUnknown; }
  [[nodiscard]] bool is_like(const GroundColour& other) const;
  /// The first image decides. Later ones are averaged, or count against what is known, until another ground has been
  /// seen as often. An entry without images changes nothing.
  void learn(const GroundColour& seen);
  static constexpr std::int32_t kMemoryImages = 30;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(colour, tint.red, tint.blue, images);
  }
};

/// What an image shows of the ground; without images if it shows too little of it. Ground has a colour if most columns
/// of the image show it from 1.5 m to 3.4 m away, which is beyond the zones that a robot drives over, and not above the
/// horizon. `rgb`: the smoothed image, `labels`: its colours. The memory of `samples` is used again.
[[nodiscard]] GroundColour ground_in_view(const cv::Mat& rgb, const Labels& labels, const GroundCamera& camera,
                                          TintSamples& samples);

/// Takes their label from the pixels of coloured ground. What remains of its colour are objects and zones of another
/// saturation, and everything that reaches above the horizon, down to where its shade changes on the ground.
void remove_ground(const cv::Mat& rgb, const GroundColour& ground, const GroundCamera& camera, Labels& labels);

}  // namespace constrictor::perception
