#include "perception/glare.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "configuration/quantiles.hpp"
#include "perception/ground_colour.hpp"

namespace constrictor::perception {
namespace {

constexpr int kGridColumns = 4, kGridRows = 8;  // [pixel] between the places at which glare is looked for
constexpr int kBright = 195;                    // least value of all channels (of 255) in glare
constexpr double kBrighter = 1.15;              // than the usual ground
constexpr double kNoise_sd = 5.0;               // glare is brighter than the usual ground by so much of its noise, too
constexpr double kLeastGlareShare = 0.003;      // of the ground in view
constexpr double kLitShare = 0.6;    // of the ground is at most as bright as usual; more rarely lies in shadow
constexpr double kAsBright = 0.9;    // as the usual ground: no paint is so bright in all channels without glare
constexpr double kOtherTint = 0.03;  // least difference of a pale colour from the usual ground
// Where one channel is saturated and all are so bright, the tint of a paint cannot be told from that of the ground.
constexpr int kSaturated = 250, kWashedOut = 220;

int darkest_channel(const std::uint8_t* rgb) { return std::min({rgb[0], rgb[1], rgb[2]}); }

/// The usual brightness and tint of ground without a colour; the brightness is 0 if there is no glare.
struct UsualGround {
  double brightness = 0.0;
  Tint tint;
};

int first_ground_row(const GroundCamera& camera, int u) {
  return std::max(camera.horizon_pixel(u) + kHorizonErrorPixels, 0);
}

/// Standard deviation of the ground's darkest channel, from the differences of places that lie beside each other:
/// shadows and glare have few borders.
double noise_sd(const cv::Mat& rgb, const GroundCamera& camera, const Labels& labels,
                std::vector<double>& differences) {
  constexpr double kMedianOfNormal = 0.6745;  // median of the absolute value, for a standard deviation of 1
  differences.clear();
  const auto unlabelled = [&](int v, int u) { return labels.image.at<std::uint8_t>(v, u) == msg::kColourUnknown; };
  for (int u = kGridColumns / 2 + kGridColumns; u < rgb.cols; u += kGridColumns) {
    for (int v = first_ground_row(camera, u); v < rgb.rows; v += kGridRows) {
      if (!unlabelled(v, u) || !unlabelled(v, u - kGridColumns)) continue;
      const std::uint8_t* pixel = rgb.ptr<std::uint8_t>(v) + 3 * u;
      differences.push_back(std::abs(darkest_channel(pixel) - darkest_channel(pixel - 3 * kGridColumns)));
    }
  }
  return differences.empty() ? 0.0 : upper_median(differences) / (kMedianOfNormal * std::numbers::sqrt2);
}

UsualGround ground_under_glare(const cv::Mat& rgb, const GroundCamera& camera, const Labels& labels,
                               GlareBuffers& buffers) {
  auto& [bright, ground, brightness, differences, tints] = buffers;
  bright.clear();
  ground.clear();
  for (int u = kGridColumns / 2; u < rgb.cols; u += kGridColumns) {
    for (int v = first_ground_row(camera, u); v < rgb.rows; v += kGridRows) {
      const std::uint8_t* pixel = rgb.ptr<std::uint8_t>(v) + 3 * u;
      if (darkest_channel(pixel) >= kBright && !camera.own_body(u + 0.5, v + 0.5)) bright.push_back(pixel);
      if (labels.image.at<std::uint8_t>(v, u) == msg::kColourUnknown) ground.push_back(pixel);
    }
  }
  const auto least = static_cast<std::size_t>(kLeastGlareShare * static_cast<double>(ground.size())) + 1;
  if (bright.size() < least) return {};
  brightness.clear();
  tints.clear();
  for (const std::uint8_t* pixel : ground) {
    brightness.push_back(darkest_channel(pixel));
    tints.add(Tint::of(pixel));
  }
  const auto usual =
      brightness.begin() + static_cast<std::ptrdiff_t>(kLitShare * static_cast<double>(brightness.size()));
  std::nth_element(brightness.begin(), usual, brightness.end());
  const double least_bright = std::max({static_cast<double>(kBright), kBrighter * *usual,
                                        *usual + kNoise_sd * noise_sd(rgb, camera, labels, differences)});
  const auto in_glare = std::count_if(
      bright.begin(), bright.end(), [&](const std::uint8_t* pixel) { return darkest_channel(pixel) >= least_bright; });
  if (static_cast<std::size_t>(in_glare) < least) return {};
  return {*usual, tints.usual()};
}

}  // namespace

bool recover_pale_colours(const cv::Mat& rgb, const ColourClassifier& classifier, const GroundCamera& camera,
                          GlareBuffers& buffers, Labels& labels) {
  const UsualGround usual = ground_under_glare(rgb, camera, labels, buffers);
  if (usual.brightness <= 0.0) return false;
  bool dazzled = false;
  for (int u = 0; u < rgb.cols; ++u) {
    for (int v = first_ground_row(camera, u); v < rgb.rows; ++v) {
      std::uint8_t& label = labels.image.at<std::uint8_t>(v, u);
      const std::uint8_t* pixel = rgb.ptr<std::uint8_t>(v) + 3 * u;
      const int darkest = darkest_channel(pixel);
      if (label != msg::kColourUnknown || darkest < kAsBright * usual.brightness) continue;
      if (Tint::of(pixel).distance(usual.tint) >= kOtherTint) {
        label = classifier.colour_of_hue(pixel[0], pixel[1], pixel[2]);
        if (label != msg::kColourUnknown) labels.extents[label].add(u, v);
      } else if (darkest >= kWashedOut && std::max({pixel[0], pixel[1], pixel[2]}) >= kSaturated) {
        label = kDazzled;
        dazzled = true;
      }
    }
  }
  return dazzled;
}

}  // namespace constrictor::perception
