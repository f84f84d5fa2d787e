#include "perception/ground_colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "configuration/quantiles.hpp"

namespace constrictor::perception {
namespace {

constexpr double kLeastShare = 0.05;  // of the image that has the ground's colour, also at a bound of its hues
constexpr int kColumnsApart = 8;      // [pixel] between the columns in which the ground is looked at
constexpr int kSampleApart = 8;       // [pixel] between the pixels whose tints are averaged
constexpr double kBandNear_m = 1.5;   // the ground is looked at from here
constexpr double kBandFar_m = 3.4;    // to here
constexpr double kSameShade = 15.0;   // least change of a channel (of 255) at the foot of an object
constexpr int kLastingPixels = 3;     // over which this change must last

enum class Ground { kHidden, kPlain, kColoured };

/// Rows of a column that show ground: the farthest and the nearest, and one that ground never reaches.
struct Rows {
  int above, far, near;
};

std::uint8_t most_frequent_colour(const Labels& labels) {
  const auto fewer = [](const ColourExtent& a, const ColourExtent& b) { return a.pixels < b.pixels; };
  const auto most = std::max_element(labels.extents.begin(), labels.extents.end(), fewer);
  const bool enough = most->pixels >= kLeastShare * static_cast<double>(labels.image.total());
  return enough ? static_cast<std::uint8_t>(most - labels.extents.begin()) : std::uint8_t{msg::kColourUnknown};
}

/// The tint of most pixels of a colour below the horizon.
Tint usual_tint(const cv::Mat& rgb, const Labels& labels, const GroundCamera& camera, std::uint8_t colour,
                TintSamples& samples) {
  samples.clear();
  for (int v = 0; v < rgb.rows; v += kSampleApart) {
    for (int u = 0; u < rgb.cols; u += kSampleApart) {
      if (labels.image.at<std::uint8_t>(v, u) != colour || v < camera.horizon_row(u + 0.5) + 1.0) continue;
      samples.add(Tint::of(rgb.ptr<std::uint8_t>(v) + 3 * u));
    }
  }
  return samples.usual();
}

/// `colour`: the most frequent colour of the image, of this usual tint.
Ground ground_in_column(const cv::Mat& rgb, const Labels& labels, const GroundCamera& camera, std::uint8_t colour,
                        const Tint& usual, int u) {
  const double horizon = camera.horizon_row(u + 0.5);
  const double height = camera.focal_pixels() * camera.height_m();
  const Rows rows{camera.horizon_pixel(u) - kHorizonErrorPixels,
                  static_cast<int>(std::lround(horizon + height / kBandFar_m)),
                  static_cast<int>(std::lround(horizon + height / kBandNear_m))};
  if (rows.above < 0 || rows.near >= labels.image.rows) return Ground::kHidden;
  if (camera.own_body(u + 0.5, rows.far + 0.5) || camera.own_body(u + 0.5, rows.near + 0.5)) return Ground::kHidden;
  const auto label = [&](int v) { return labels.image.at<std::uint8_t>(v, u); };
  if (label(rows.above) != msg::kColourUnknown) return Ground::kHidden;  // something stands there
  // At a bound of the colour's hues, only a part of the ground has its label.
  const auto is_usual = [&](int v) {
    return Tint::of(rgb.ptr<std::uint8_t>(v) + 3 * u).distance(usual) < Tint::kTolerance;
  };
  if (colour != msg::kColourUnknown && is_usual(rows.far) && is_usual(rows.near)) return Ground::kColoured;
  const bool plain = label(rows.far) == msg::kColourUnknown && label(rows.near) == msg::kColourUnknown;
  return plain ? Ground::kPlain : Ground::kHidden;
}

/// The lowest row, from the horizon on, that the object in a column of the image reaches without a change of shade. The
/// horizon, if the shade never changes.
int foot_row(const cv::Mat& rgb, const GroundCamera& camera, int u, int horizon) {
  std::array<double, 3> shade{};
  for (int v = horizon - kHorizonErrorPixels; v < horizon; ++v) {
    for (std::size_t c = 0; c < 3; ++c) shade[c] += rgb.ptr<std::uint8_t>(v)[3 * u + static_cast<int>(c)];
  }
  for (double& channel : shade) channel /= kHorizonErrorPixels;
  int other = 0;
  for (int v = horizon; v < rgb.rows && !camera.own_body(u + 0.5, v + 0.5); ++v) {
    const std::uint8_t* pixel = rgb.ptr<std::uint8_t>(v) + 3 * u;
    double change = 0.0;
    for (std::size_t c = 0; c < 3; ++c) change = std::max(change, std::abs(pixel[c] - shade[c]));
    other = change > kSameShade ? other + 1 : 0;
    if (other == kLastingPixels) return v - kLastingPixels;
  }
  return horizon;
}

}  // namespace

double Tint::distance(const Tint& other) const {
  const double red_more = red - other.red, blue_more = blue - other.blue;
  return std::max({std::abs(red_more), std::abs(blue_more), std::abs(red_more + blue_more)});
}

Tint Tint::of(const std::uint8_t* rgb) {
  const double sum = std::max(rgb[0] + rgb[1] + rgb[2], 1);
  return {rgb[0] / sum, rgb[2] / sum};
}

void TintSamples::clear() {
  red_.clear();
  blue_.clear();
}

void TintSamples::add(const Tint& tint) {
  red_.push_back(tint.red);
  blue_.push_back(tint.blue);
}

Tint TintSamples::usual() { return red_.empty() ? Tint{} : Tint{upper_median(red_), upper_median(blue_)}; }

bool GroundColour::is_like(const GroundColour& other) const {
  return colour == other.colour && (!coloured() || tint.distance(other.tint) < Tint::kTolerance);
}

void GroundColour::learn(const GroundColour& seen) {
  if (seen.images == 0) return;
  if (images == 0) {
    *this = seen;
  } else if (!is_like(seen)) {
    --images;
  } else {
    images = std::min(images + 1, kMemoryImages);
    tint.red += (seen.tint.red - tint.red) / images;
    tint.blue += (seen.tint.blue - tint.blue) / images;
  }
}

GroundColour ground_in_view(const cv::Mat& rgb, const Labels& labels, const GroundCamera& camera,
                            TintSamples& samples) {
  const std::uint8_t colour = most_frequent_colour(labels);
  const Tint usual = colour == msg::kColourUnknown ? Tint{} : usual_tint(rgb, labels, camera, colour, samples);
  int plain = 0, coloured = 0, columns = 0;
  for (int u = kColumnsApart / 2; u < rgb.cols; u += kColumnsApart, ++columns) {
    const Ground ground = ground_in_column(rgb, labels, camera, colour, usual, u);
    plain += ground == Ground::kPlain ? 1 : 0;
    coloured += ground == Ground::kColoured ? 1 : 0;
  }
  constexpr double kMost = 0.8;  // of the columns in which ground is seen
  if (2 * (plain + coloured) < columns) return {};
  if (coloured >= kMost * (plain + coloured)) return {colour, usual, 1};
  if (plain >= kMost * (plain + coloured)) return {msg::kColourUnknown, {}, 1};
  return {};
}

void remove_ground(const cv::Mat& rgb, const GroundColour& ground, const GroundCamera& camera, Labels& labels) {
  static const cv::Mat kSquare = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  // Down to these rows, nothing is ground.
  std::vector<int> last_upright(static_cast<std::size_t>(rgb.cols));
  for (int u = 0; u < rgb.cols; ++u) {
    const int horizon = camera.horizon_pixel(u);
    const int top = horizon - kHorizonErrorPixels;
    const bool rises = top > 0 && horizon < rgb.rows && labels.image.at<std::uint8_t>(top - 1, u) == ground.colour;
    last_upright[static_cast<std::size_t>(u)] = rises ? foot_row(rgb, camera, u, horizon) : top - 1;
  }
  cv::Mat remaining(labels.image.size(), CV_8UC1, cv::Scalar(0));
  for (int v = 0; v < rgb.rows; ++v) {
    const std::uint8_t* label = labels.image.ptr<std::uint8_t>(v);
    const std::uint8_t* pixel = rgb.ptr<std::uint8_t>(v);
    std::uint8_t* to = remaining.ptr<std::uint8_t>(v);
    for (int u = 0; u < rgb.cols; ++u) {
      if (label[u] != ground.colour) continue;
      const bool upright = v <= last_upright[static_cast<std::size_t>(u)];
      if (upright || Tint::of(pixel + 3 * u).distance(ground.tint) >= Tint::kTolerance) to[u] = 255;
    }
  }
  // Where the ground adjoins another colour, a pixel or two have a mixture of both.
  cv::morphologyEx(remaining, remaining, cv::MORPH_OPEN, kSquare);
  ColourExtent& extent = labels.extents[ground.colour];
  extent = {};
  for (int v = 0; v < rgb.rows; ++v) {
    std::uint8_t* label = labels.image.ptr<std::uint8_t>(v);
    const std::uint8_t* kept = remaining.ptr<std::uint8_t>(v);
    for (int u = 0; u < rgb.cols; ++u) {
      if (label[u] != ground.colour) continue;
      if (kept[u] != 0) extent.add(u, v);
      else label[u] = msg::kColourUnknown;
    }
  }
}

}  // namespace constrictor::perception
