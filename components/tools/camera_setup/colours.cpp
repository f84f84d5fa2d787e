#include "camera_setup/colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "configuration/quantiles.hpp"
#include "constrictor/constants.hpp"

namespace constrictor::camera_setup {
namespace {

constexpr double kOutside = 0.02;                                // share of the pixels that may lie outside
constexpr double kLeastMargin_deg = 12.0;                        // hues drift with the light
constexpr double kUsualChroma = 0.075, kUsualSaturation = 0.33;  // defaults of perception
constexpr double kLeastChroma = 0.02, kLeastSaturation = 0.08;
constexpr double kMostSpread_deg = 60.0;  // the colours that are taught are at most about 120 degrees apart
constexpr const char* kGround = "ground";

double wrapped_deg(double angle) { return angle - 360.0 * std::floor(angle / 360.0); }
/// [deg] from a to b, from -180 to 180.
double turn_deg(double a, double b) { return wrapped_deg(b - a + 180.0) - 180.0; }

struct Hue {
  double deg, chroma, saturation;
};

Hue hue_of(const cv::Vec3b& bgr) {
  const double b = bgr[0] / 255.0, g = bgr[1] / 255.0, r = bgr[2] / 255.0;
  const double most = std::max({r, g, b}), chroma = most - std::min({r, g, b});
  if (chroma <= 0.0) return {0.0, 0.0, 0.0};
  const double sixth = most == r ? (g - b) / chroma : most == g ? 2.0 + (b - r) / chroma : 4.0 + (r - g) / chroma;
  return {wrapped_deg(60.0 * sixth), chroma, chroma / most};
}

/// Throws std::invalid_argument if the pixels have no colour. The hue of grey pixels is noise, or 0 (red).
void require_colour(const std::string& name, const ColourSample::Statistics& seen) {
  if (seen.chroma < kLeastChroma || seen.saturation < kLeastSaturation)
    throw std::invalid_argument(
        fmt::format("{}: found chroma {:.3f} and saturation {:.2f}, accepted at least {:.3f} and {:.2f}: the box shows "
                    "grey, white or black; is it wholly on its colour?",
                    name, seen.chroma, seen.saturation, kLeastChroma, kLeastSaturation));
  if (seen.spread_deg > kMostSpread_deg)
    throw std::invalid_argument(fmt::format(
        "{}: found hues that differ by {:.0f} degrees from their mean, accepted at most {:.0f}: the box shows several "
        "colours; is it wholly on its colour?",
        name, seen.spread_deg, kMostSpread_deg));
}

}  // namespace

void ColourSample::add(const cv::Mat& bgr, const cv::Rect& box) {
  const cv::Mat part = bgr(box);
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.cols; ++column) pixels_.push_back(part.at<cv::Vec3b>(row, column));
  }
}

ColourSample::Statistics ColourSample::statistics() const {
  Statistics found;
  found.pixels = pixels_.size();
  if (pixels_.empty()) return found;
  double x = 0.0, y = 0.0;
  std::vector<double> hues, chromas, saturations;
  for (const auto& pixel : pixels_) {
    const Hue hue = hue_of(pixel);
    x += hue.chroma * std::cos(hue.deg * std::numbers::pi / 180.0);  // a pale pixel says little about the hue
    y += hue.chroma * std::sin(hue.deg * std::numbers::pi / 180.0);
    hues.push_back(hue.deg);
    chromas.push_back(hue.chroma);
    saturations.push_back(hue.saturation);
  }
  found.hue_deg = wrapped_deg(std::atan2(y, x) * 180.0 / std::numbers::pi);
  for (double& hue : hues) hue = std::abs(turn_deg(found.hue_deg, hue));
  found.spread_deg = lower_quantile(hues, 1.0 - kOutside);
  found.highest_chroma = lower_quantile(chromas, 1.0 - kOutside);
  found.highest_saturation = lower_quantile(saturations, 1.0 - kOutside);
  found.chroma = lower_quantile(chromas, kOutside);
  found.saturation = lower_quantile(saturations, kOutside);
  return found;
}

ColourResult teach_colours(const std::map<std::string, ColourSample>& samples) {
  struct Range {
    std::string name;
    ColourSample::Statistics seen;
    double half_deg;
  };
  std::vector<Range> ranges;
  double chroma = 1.0, saturation = 1.0, ground_chroma = 0.0, ground_saturation = 0.0;
  for (const auto& [name, sample] : samples) {
    const auto seen = sample.statistics();
    if (name == kGround) {
      ground_chroma = seen.highest_chroma;
      ground_saturation = seen.highest_saturation;
      continue;
    }
    require_colour(name, seen);
    chroma = std::min(chroma, seen.chroma);
    saturation = std::min(saturation, seen.saturation);
    ranges.push_back({name, seen, std::max(1.5 * seen.spread_deg, kLeastMargin_deg)});
  }
  if (ranges.empty())
    throw std::invalid_argument("found no colour, accepted at least one of " +
                                listed(constants::kColour, msg::kColourUnknown + 1));
  std::sort(ranges.begin(), ranges.end(),
            [](const Range& a, const Range& b) { return a.seen.hue_deg < b.seen.hue_deg; });
  for (std::size_t i = 0; i < ranges.size() && ranges.size() > 1; ++i) {
    Range& one = ranges[i];
    Range& next = ranges[(i + 1) % ranges.size()];
    const double gap_deg = ranges.size() == 2 ? std::abs(turn_deg(one.seen.hue_deg, next.seen.hue_deg))
                                              : wrapped_deg(next.seen.hue_deg - one.seen.hue_deg);
    if (gap_deg < one.seen.spread_deg + next.seen.spread_deg + 2.0)
      throw std::invalid_argument(fmt::format(
          "{} and {}: found hues of {:.0f} and {:.0f} degrees that overlap, accepted colours that differ; is each box "
          "wholly on its colour?",
          one.name, next.name, one.seen.hue_deg, next.seen.hue_deg));
    // Neighbours share the gap between them.
    const double excess_deg = one.half_deg + next.half_deg + 1.0 - gap_deg;
    if (excess_deg <= 0.0) continue;
    one.half_deg -= 0.5 * excess_deg;
    next.half_deg -= 0.5 * excess_deg;
  }
  ColourResult result;
  // Below the colours, above the ground, and not stricter than usual without need.
  const auto threshold = [](double usual, double least, double colour, double ground) {
    return std::clamp(std::min(usual, 0.5 * (colour + ground)), least, 0.95);
  };
  const double min_chroma = threshold(kUsualChroma, kLeastChroma, chroma, std::min(ground_chroma, chroma));
  const double min_saturation =
      threshold(kUsualSaturation, kLeastSaturation, saturation, std::min(ground_saturation, saturation));
  // The palest colour counts, too: a threshold is never below its least value, but a colour may be.
  if (samples.contains(kGround) && ground_chroma >= std::min(min_chroma, chroma) &&
      ground_saturation >= std::min(min_saturation, saturation))
    throw std::invalid_argument(
        fmt::format("ground: found chroma {:.3f} and saturation {:.2f}, as much as the palest colour has ({:.3f}, "
                    "{:.2f}): choose stronger colours or white light",
                    ground_chroma, ground_saturation, chroma, saturation));
  if (chroma < min_chroma || saturation < min_saturation)
    result.warnings.push_back(
        fmt::format("the palest colour has chroma {:.3f} and saturation {:.2f}: not all of its "
                    "pixels will be recognised",
                    chroma, saturation));
  if (!samples.contains(kGround))
    result.warnings.emplace_back("no sample of the ground: whether it looks coloured is not known");
  result.yaml = fmt::format("colour:\n  min_chroma: {:.4f}\n  min_saturation: {:.3f}\n", min_chroma, min_saturation);
  for (const Range& range : ranges) {
    result.yaml +=
        fmt::format("  {}: {{from_deg: {:.1f}, to_deg: {:.1f}}}   # seen: {:.1f} +- {:.1f}\n", range.name,
                    wrapped_deg(range.seen.hue_deg - range.half_deg), wrapped_deg(range.seen.hue_deg + range.half_deg),
                    range.seen.hue_deg, range.seen.spread_deg);
  }
  return result;
}

}  // namespace constrictor::camera_setup
