#include "perception/object_on_zone.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "perception/sight.hpp"
#include "perception/silhouette.hpp"

namespace constrictor::perception {
namespace {

constexpr double kAboveRimPixels = 2.5;  // above the far rim of the zone
constexpr int kMaxGapColumns = 2;        // that noise makes in the outline of an object
constexpr double kAboveCamera_m = 0.01;  // a higher object reaches far above the horizon
constexpr double kHeightError_m = 0.025;
constexpr double kCertain_sd = 2.0;  // three columns or more rise above the rim, as wide as an object of known size

/// Successive columns; empty if last < first.
struct Columns {
  int first = 0, last = -1;
  [[nodiscard]] int count() const { return last - first + 1; }
};

/// The highest row of a region in a column; -1: there is none.
int top_row(const Regions& regions, std::size_t index, int u) {
  const Region& region = regions.regions[index];
  for (int v = region.v_min; v <= region.v_max; ++v) {
    if (regions.ids.at<std::uint8_t>(v, u) == index + 1) return v;
  }
  return -1;
}

/// The outline of a zone without the objects on it.
struct ZoneOutline {
  Disc disc;
  double middle_rad = 0.0;

  /// Whether the line of sight to a pixel passes above the far rim.
  [[nodiscard]] bool below(const GroundCamera& camera, const Eigen::Vector2d& pixel) const {
    const double far_m = disc.far_m(azimuth_rad(camera, pixel) - middle_rad);
    return descent(camera, pixel) < camera.height_m() / far_m - kAboveRimPixels / camera.focal_pixels();
  }
};

std::optional<ZoneOutline> outline_of(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions,
                                      std::size_t index) {
  const Region& zone = regions.regions[index];
  if (zone.left_hidden || zone.right_hidden) return std::nullopt;
  if (zone.u_min == 0 || zone.u_max == camera.width() - 1 || zone.v_max == camera.height() - 1) return std::nullopt;
  const Sides sides = sides_of(rgb, camera, regions, index);
  const auto paths = walk_paths(rgb, camera, regions, index, sides);
  if (sides.angle_rad() <= 0.0 || 2 * paths.size() <= kPaths) return std::nullopt;
  return ZoneOutline{Disc::of(sides, paths), sides.middle_rad()};
}

/// The most columns without a large gap in which the region rises above the zone.
Columns risen_columns(const GroundCamera& camera, const Regions& regions, std::size_t index,
                      const ZoneOutline& outline) {
  const Region& region = regions.regions[index];
  Columns best, run;
  for (int u = region.u_min; u <= region.u_max; ++u) {
    const int v = top_row(regions, index, u);
    if (v < 0 || !outline.below(camera, {u + 0.5, static_cast<double>(v)})) continue;
    if (run.count() == 0 || u - run.last > kMaxGapColumns + 1) run.first = u;
    run.last = u;
    if (run.count() > best.count()) best = run;
  }
  return best;
}

/// Whether the highest edge in the middle of the columns fits an object of this size that stands on the zone.
bool fits(const GroundCamera& camera, const Regions& regions, std::size_t index, const Columns& columns,
          const ZoneOutline& outline, const ObjectSize& size, double angle_rad) {
  const int u = (columns.first + columns.last) / 2;
  const double slope = descent(camera, {u + 0.5, static_cast<double>(top_row(regions, index, u))});
  const double centre_m = size.radius_m / std::sin(0.5 * angle_rad);
  const double height_m = camera.height_m() - (centre_m + size.radius_m) * slope;
  const bool on_zone = std::abs(centre_m - outline.disc.centre_m) < outline.disc.radius_m + size.radius_m;
  return on_zone && std::abs(height_m - size.height_m) < kHeightError_m;
}

/// Gives the pixels that rise above the zone, in these columns, to a new region, and returns it.
Region& split(const GroundCamera& camera, const Columns& columns, const ZoneOutline& outline, std::size_t index,
              Regions& regions) {
  const Region zone = regions.regions[index];
  Region object;
  object.colour = zone.colour;
  object.u_min = columns.first;
  object.u_max = columns.last;
  object.v_max = -1;
  const auto id = static_cast<std::uint8_t>(regions.regions.size() + 1);
  for (int v = zone.v_min; v <= zone.v_max; ++v) {
    for (int u = columns.first; u <= columns.last; ++u) {
      if (regions.ids.at<std::uint8_t>(v, u) != index + 1) continue;
      if (!outline.below(camera, {u + 0.5, static_cast<double>(v)})) continue;
      regions.ids.at<std::uint8_t>(v, u) = id;
      if (object.v_max < 0) object.v_min = v;
      object.v_max = v;
      ++object.area;
    }
  }
  regions.regions[index].area -= object.area;
  return regions.regions.emplace_back(object);
}

}  // namespace

void split_objects_from_zones(const cv::Mat& rgb, const GroundCamera& camera, const PerceptionConfig& config,
                              const ObjectSizes& sizes, Regions& regions) {
  const std::size_t count = regions.regions.size();
  for (std::size_t i = 0; i < count && regions.regions.size() < kMaxRegions; ++i) {
    const Region zone = regions.regions[i];
    const auto known = sizes.of[zone.colour].candidates();
    if (zone.area < 4 * config.min_area_pixels || zone.line || zone.standing()) continue;
    const auto may_be_low = [&](const ObjectSize& size) { return size.height_m <= camera.height_m() + kAboveCamera_m; };
    if (std::none_of(known.begin(), known.end(), may_be_low)) continue;
    const auto outline = outline_of(rgb, camera, regions, i);
    if (!outline) continue;
    const Columns columns = risen_columns(camera, regions, i, *outline);
    if (columns.count() < 3) continue;
    const double row = zone.v_min + 0.5;
    const double left_rad = azimuth_rad(camera, {static_cast<double>(columns.first), row});
    const double right_rad = azimuth_rad(camera, {columns.last + 1.0, row});
    const auto size = std::find_if(known.begin(), known.end(), [&](const ObjectSize& one) {
      return may_be_low(one) && fits(camera, regions, i, columns, *outline, one, left_rad - right_rad);
    });
    if (size == known.end()) continue;
    const double height_m = size->height_m;
    Region& object = split(camera, columns, *outline, i, regions);
    object.stand_low(left_rad, right_rad, height_m);
    object.rise_sd = kCertain_sd;
    object.on_zone = true;
  }
}

}  // namespace constrictor::perception
