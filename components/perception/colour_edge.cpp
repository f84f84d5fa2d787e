#include "perception/colour_edge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "perception/perception_config.hpp"

namespace constrictor::perception {
namespace {

constexpr double kStep = 0.5;    // [pixel]
constexpr double kBorder = 1.5;  // [pixel] of the image, ahead
constexpr double kBeside = 3.0;  // [pixel] of the image, beside

bool inside(const cv::Mat& image, const Eigen::Vector2d& p) {
  return p.x() >= 0.0 && p.y() >= 0.0 && p.x() < image.cols && p.y() < image.rows;
}

std::uint8_t id_at(const cv::Mat& ids, const Eigen::Vector2d& p) {
  return ids.at<std::uint8_t>(static_cast<int>(p.y()), static_cast<int>(p.x()));
}

/// The primary or mixed colour that is nearest to the middle of each colour's shipped hues: 0 red, 1 yellow, 2 green,
/// 3 cyan, 4 blue, 5 magenta.
constexpr std::array<std::uint8_t, msg::kColourCount> kSixths = [] {
  std::array<std::uint8_t, msg::kColourCount> sixths{};
  for (std::size_t colour = 0; colour < sixths.size(); ++colour) {
    const auto [from_deg, to_deg] = kShippedHues[colour];
    const double middle_deg = 0.5 * (from_deg + to_deg + (from_deg > to_deg ? 360.0 : 0.0));
    sixths[colour] = static_cast<std::uint8_t>(static_cast<int>((middle_deg + 30.0) / 60.0) % 6);
  }
  return sixths;
}();

double strength(std::uint8_t colour, const std::array<double, 3>& rgb) {
  if (colour == msg::kColourUnknown || colour >= msg::kColourCount) return 0.0;
  const std::size_t sixth = kSixths[colour];
  const bool primary = sixth % 2 == 0;
  const std::size_t one = primary ? sixth / 2 : (sixth / 2 + 2) % 3;  // the channel that differs from the two others
  const double others = 0.5 * (rgb[(one + 1) % 3] + rgb[(one + 2) % 3]);
  return primary ? rgb[one] - others : others - rgb[one];
}

/// The channels at a point between the centres of pixels.
std::array<double, 3> channels_at(const cv::Mat& rgb, const Eigen::Vector2d& pixel) {
  const double x = std::clamp(pixel.x() - 0.5, 0.0, rgb.cols - 1.001);
  const double y = std::clamp(pixel.y() - 0.5, 0.0, rgb.rows - 1.001);
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const double fx = x - u, fy = y - v;
  const std::uint8_t* upper = rgb.ptr<std::uint8_t>(v) + 3 * u;
  const std::uint8_t* lower = rgb.ptr<std::uint8_t>(std::min(v + 1, rgb.rows - 1)) + 3 * u;
  std::array<double, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = (1 - fy) * ((1 - fx) * upper[i] + fx * upper[i + 3]) + fy * ((1 - fx) * lower[i] + fx * lower[i + 3]);
  }
  return c;
}

/// By how much the saturation at a point exceeds that of ground of this colour; the same in light and shadow.
double strength_above_ground(const cv::Mat& rgb, const GroundColour& ground, const Eigen::Vector2d& pixel) {
  const std::array<double, 3> c = channels_at(rgb, pixel);
  const double sum = std::max(c[0] + c[1] + c[2], 1.0);
  const Tint& tint = ground.tint;
  const double of_ground = strength(ground.colour, {tint.red, 1.0 - tint.red - tint.blue, tint.blue});
  return 255.0 * std::max(strength(ground.colour, c) / sum - of_ground, 0.0);
}

}  // namespace

double colour_strength(const cv::Mat& rgb, std::uint8_t colour, const Eigen::Vector2d& pixel) {
  return strength(colour, channels_at(rgb, pixel));
}

Edge find_edge(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera, std::uint8_t id,
               const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double max_gap) {
  double first = -1.0, last = -1.0;
  for (double t = 0.0;; t += kStep) {
    const Eigen::Vector2d p = start + t * direction;
    if (!inside(rgb, p)) break;
    if (id_at(regions.ids, p) == id) {
      if (first < 0.0) first = t;
      last = t;
    } else if (t - std::max(last, 0.0) > max_gap) {
      break;
    }
  }
  Edge edge;
  if (last < 0.0) return edge;

  const Region& region = regions.regions[static_cast<std::size_t>(id - 1)];
  const GroundColour& ground = regions.ground;
  const bool like_ground = ground.coloured() && region.colour == ground.colour;
  const auto value = [&](double t) {
    const Eigen::Vector2d p = start + t * direction;
    return like_ground ? strength_above_ground(rgb, ground, p) : colour_strength(rgb, region.colour, p);
  };
  edge.pixel = start + last * direction;
  // A walk along the border may leave a region only because the border cuts its side.
  const double aside = std::min(edge.pixel.x(), rgb.cols - edge.pixel.x());
  if (aside < kBeside || !inside(rgb, edge.pixel + kBorder * direction)) {
    edge.state = EdgeState::kCut;
    return edge;
  }
  for (double t = last + 1.0; t <= last + 4.0; t += 1.0) {
    const Eigen::Vector2d p = start + t * direction;
    if (!inside(rgb, p)) break;
    const std::uint8_t other = id_at(regions.ids, p);
    if (camera.own_body(p.x(), p.y())) {
      edge.state = EdgeState::kCut;
      return edge;
    }
    if (regions.dazzled_at(static_cast<int>(p.x()), static_cast<int>(p.y()))) {
      edge.state = EdgeState::kHidden;
      return edge;
    }
    if (other != 0 && other != id && regions.regions[other - 1u].standing()) {
      edge.state = EdgeState::kHidden;
      return edge;
    }
  }

  // The levels well inside and well outside, then the point half-way between them.
  double level_in = -1e9, level_out = 1e9;
  if (last - first >= 6.0) {
    level_in = (value(last - 5.0) + value(last - 4.0) + value(last - 3.0)) / 3.0;
  } else {
    for (double t = first; t <= last; t += kStep) level_in = std::max(level_in, value(t));
  }
  for (double t = last + 2.0; t <= last + 5.0 && inside(rgb, start + t * direction); t += 1.0) {
    level_out = std::min(level_out, value(t));
  }
  edge.state = EdgeState::kSeen;
  if (level_out > level_in) return edge;
  level_out = std::max(level_out, 0.0);
  const double half = 0.5 * (level_in + level_out);
  double previous = value(std::max(last - 3.0, first));
  for (double t = std::max(last - 3.0, first) + kStep; t <= last + 4.0; t += kStep) {
    const double current = value(t);
    if (current < half) {
      const double fraction = previous > current ? std::clamp((previous - half) / (previous - current), 0.0, 1.0) : 1.0;
      edge.pixel = start + (t - kStep + kStep * fraction) * direction;
      return edge;
    }
    previous = current;
  }
  return edge;
}

}  // namespace constrictor::perception
