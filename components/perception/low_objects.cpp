#include "perception/low_objects.hpp"

#include <algorithm>
#include <cmath>

#include "configuration/quantiles.hpp"
#include "perception/silhouette.hpp"

namespace constrictor::perception {
namespace {

constexpr double kLeastObjectHeight_m = 0.02;
constexpr double kRisePixels = 2.0;  // the least height is also this many pixels
constexpr double kHorizonPixels = 3.0;

enum class Rise { kFlat, kLow, kDoubtful };

/// The height of a region, and by how many standard deviations it exceeds the bound between flat and upright.
struct Height {
  double m = 0.0;
  double sd = 0.0;
};

/// A region of which the image shows one side. Close to this side a disc is thin: its nearest and farthest edges
/// coincide there. `height` becomes that of what rises there.
Rise rise_at_side(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::size_t index,
                  const Sides& sides, Height& height) {
  constexpr double kInside = 2.5;  // [pixel]
  constexpr double kFlat_m = 0.02, kLow_m = 0.04;
  const Region& region = regions.regions[index];
  const bool left = region.u_min > 0 && !region.left_hidden;
  const double inside_rad = kInside / camera.focal_pixels();
  if (sides.angle_rad() < 2.0 * inside_rad) return Rise::kDoubtful;
  const auto path =
      walk(rgb, camera, regions, index, left ? sides.left_rad - inside_rad : sides.right_rad + inside_rad);
  if (!path) return Rise::kDoubtful;
  height.m = camera.height_m() - path->near_m * std::max(path->slope, 0.0);
  height.sd = (height.m - 0.5 * (kFlat_m + kLow_m)) / (0.5 * (kLow_m - kFlat_m));
  return height.m < kFlat_m ? Rise::kFlat : height.m > kLow_m ? Rise::kLow : Rise::kDoubtful;
}

/// For a region of which the image shows both sides: the nearest edge and the sides of a disc determine where its
/// farthest edge lies. `height` becomes that of a round object whose farthest rim is the highest edge. The error of an
/// edge is taken as one pixel.
Rise rise_of_whole(const Few<Path, kPaths>& paths, const GroundCamera& camera, const Sides& sides, Height& height) {
  if (2 * paths.size() <= kPaths) return Rise::kDoubtful;
  const Disc disc = Disc::of(sides, paths);
  Few<double, kPaths> heights;
  for (const Path& path : paths)
    heights.push_back(camera.height_m() - disc.far_m(path.aside_rad) * std::max(path.slope, 0.0));
  const double least_m = std::max(kLeastObjectHeight_m, kRisePixels * disc.centre_m / camera.focal_pixels());
  const double lowest_m = *std::min_element(heights.begin(), heights.end());
  height.m = upper_median(heights);
  height.sd = std::min(height.m - least_m, 2.0 * lowest_m - least_m) / (least_m / kRisePixels);
  return height.sd >= 0.0 ? Rise::kLow : Rise::kFlat;
}

}  // namespace

void mark_low_objects(const cv::Mat& rgb, const GroundCamera& camera, const PerceptionConfig& config,
                      Regions& regions) {
  for (std::size_t i = 0; i < regions.regions.size(); ++i) {
    Region& region = regions.regions[i];
    if (region.area < config.min_area_pixels || region.line) continue;
    // An object as high as the camera reaches above the horizon by a few pixels at most.
    const double horizon = std::min(camera.horizon_row(region.u_min), camera.horizon_row(region.u_max + 1.0));
    const double above = horizon - region.v_min;
    if (region.standing() && above > kHorizonPixels) continue;
    const Sides sides = sides_of(rgb, camera, regions, i);
    if (sides.left_rad <= sides.right_rad) continue;
    const double radius_m = Disc::between_tangents(sides.nearest_m, sides.angle_rad()).radius_m;
    if (radius_m > config.object_max_radius_m) {
      constexpr double kRadiusShare = 0.05;  // standard deviation of a measured radius
      if (!region.standing()) region.rise_sd = (config.object_max_radius_m / radius_m - 1.0) / kRadiusShare;
      continue;
    }
    region.left_hidden = sides.left_hidden;
    region.right_hidden = sides.right_hidden;
    const bool cut_left = region.u_min == 0 || region.left_hidden;
    const bool cut_right = region.u_max == camera.width() - 1 || region.right_hidden;
    Height height;
    Rise rise = Rise::kDoubtful;
    if (cut_left != cut_right) {
      rise = rise_at_side(rgb, camera, regions, i, sides, height);
    } else if (!cut_left) {
      rise = rise_of_whole(walk_paths(rgb, camera, regions, i, sides), camera, sides, height);
    }
    // Glare hides one side: what is left of a zone may have any shape.
    if (!regions.dazzled.empty() && (sides.left_hidden || sides.right_hidden)) rise = Rise::kDoubtful;
    region.doubtful = rise == Rise::kDoubtful && !region.standing();
    if (rise == Rise::kLow || !region.standing()) region.rise_sd = height.sd;
    if (rise != Rise::kLow) continue;
    region.stand_low(sides.left_rad, sides.right_rad, height.m);
  }
}

}  // namespace constrictor::perception
