// The part of Gauge that finds the range of an object by the sizes that objects of its colour are known to have.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "configuration/quantiles.hpp"
#include "perception/gauge.hpp"
#include "perception/silhouette.hpp"

namespace constrictor::perception {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastAbove_m = 0.02;  // an object that is hardly higher than the camera shows no range by its height

}  // namespace

bool Gauge::ends_in_zone(double range_m) const {
  constexpr double kFar_m = 1.5;  // nearer, the zone is several pixels high, and is told from the object
  constexpr double kNarrow = 0.88;
  if (range_m <= kFar_m) return false;
  const auto sizes = sizes_.candidates();
  const auto narrower = [&](const ObjectSize& size) { return range_m < kNarrow * range_by_width(size); };
  return !sizes.empty() && std::all_of(sizes.begin(), sizes.end(), narrower);
}

double Gauge::range_by_width(const ObjectSize& size) const {
  const double sine = std::sin(0.5 * (left_ - right_));
  return size.known() && sine > 1e-3 ? size.radius_m * (1.0 / sine - 1.0) : kUnknown;
}

double Gauge::range_by_height(double height_m, double slope) const {
  const double above_m = height_m - camera_.height_m();
  return slope > 1e-3 && above_m >= kLeastAbove_m ? above_m / slope : kUnknown;  // NaN: no edge is in view
}

double Gauge::upper_slope() const {
  Few<double, kPaths> slopes = upper_edge_slopes(rgb_, camera_, regions_, id_, right_, left_);
  return slopes.empty() ? kUnknown : upper_median(slopes);
}

ObjectSize Gauge::likeliest_size(const msg::Blob& blob, double slope, bool on_zone) const {
  constexpr double kShare = 0.15;     // standard deviation of a range by the width, as a share of it
  constexpr double kPixels = 1.0;     // standard deviation of an edge
  constexpr double kHeight_m = 0.02;  // standard deviation of a known height
  constexpr double kOlder = 1.0;      // cost of a size that was not measured last
  const auto sizes = sizes_.candidates();
  if (sizes.size() < 2) return sizes.empty() ? ObjectSize{} : sizes.front();
  const double pixel_rad = kPixels / camera_.focal_pixels();
  const bool whole = std::isfinite(slope) && !blob.cut_left && !blob.cut_right && !blob.cut_top;
  const auto [near_m, far_m] = on_zone ? ground_around() : std::pair(0.0, std::numeric_limits<double>::infinity());
  ObjectSize best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const ObjectSize& size : sizes) {
    double cost = best.known() ? kOlder : 0.0;
    const double range_m = range_by_width(size);
    if (whole && std::isfinite(range_m)) {
      const double range_sd_m = range_m * std::hypot(kShare, pixel_rad / (left_ - right_));
      const double sd_m = std::hypot(range_sd_m * slope, range_m * pixel_rad, kHeight_m);
      const double outside_m = std::max({near_m - range_m, range_m - far_m, 0.0});
      cost += std::pow((camera_.height_m() + range_m * slope - size.height_m) / sd_m, 2.0);
      cost += std::pow(outside_m / range_sd_m, 2.0);
    }
    if (cost >= best_cost) continue;
    best = size;
    best_cost = cost;
  }
  return best;
}

std::pair<double, double> Gauge::ground_around() const {
  bool cut = false;
  const double near_m = lower_edge_range(left_, right_, cut);
  const auto flat = zone();
  const bool whole = flat && !flat->cut_left && !flat->cut_right && std::isfinite(flat->width_m);
  return {std::isfinite(near_m) && !cut ? near_m : 0.0,
          std::isfinite(near_m) && whole ? near_m + flat->width_m : std::numeric_limits<double>::infinity()};
}

double Gauge::range_by_size(const msg::Blob& blob, bool on_zone) const {
  const double slope = upper_slope();
  const ObjectSize size = likeliest_size(blob, slope, on_zone);
  const double by_width_m = range_by_width(size);
  if (std::isfinite(by_width_m) && !blob.cut_left && !blob.cut_right) return by_width_m;
  return range_by_height(size.known() ? size.height_m : config_.object_height_m, slope);
}

}  // namespace constrictor::perception
