#include "perception/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "configuration/quantiles.hpp"
#include "perception/colour_edge.hpp"
#include "perception/sight.hpp"

namespace constrictor::perception {
namespace {

constexpr double kMiddle = 0.6;  // share of the width over which the paths are spread
constexpr double kAnyGap = 1e9;  // [pixel] the walk to an edge passes over every hole

}  // namespace

Sides sides_of(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::size_t index) {
  const Region& region = regions.regions[index];
  const auto id = static_cast<std::uint8_t>(index + 1);
  // Something stands before the edge, or the robot's own body is there.
  const auto is_hidden = [&](const Edge& edge) {
    return edge.state == EdgeState::kHidden || (camera.sees_body() && edge.state == EdgeState::kCut);
  };
  Sides sides;
  for (int v = region.v_min; v <= region.v_max; ++v) {
    const std::uint8_t* ids = regions.ids.ptr<std::uint8_t>(v);
    int first = region.u_min, last = region.u_max;
    while (first <= last && ids[first] != id) ++first;
    while (last >= first && ids[last] != id) --last;
    if (first > last) continue;
    const Eigen::Vector2d start(0.5 * (first + last + 1), v + 0.5);
    if (const auto p = camera.ground(start.x(), start.y() + 0.5))
      sides.nearest_m = (*p - camera.position_on_ground()).norm();
    const Edge l = find_edge(rgb, regions, camera, id, start, {-1.0, 0.0}, kAnyGap);
    const Edge r = find_edge(rgb, regions, camera, id, start, {1.0, 0.0}, kAnyGap);
    if (l.state == EdgeState::kNone || r.state == EdgeState::kNone) continue;
    const double left_rad = azimuth_rad(camera, l.pixel), right_rad = azimuth_rad(camera, r.pixel);
    if (left_rad > sides.left_rad) sides.left_hidden = is_hidden(l);
    if (right_rad < sides.right_rad) sides.right_hidden = is_hidden(r);
    sides.left_rad = std::max(sides.left_rad, left_rad);
    sides.right_rad = std::min(sides.right_rad, right_rad);
  }
  return sides;
}

/// None if the border of the image, or something else, hides one of the two edges.
std::optional<Path> walk(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::size_t index,
                         double azimuth_rad) {
  const auto id = static_cast<std::uint8_t>(index + 1);
  const auto plane = vertical_plane(camera, azimuth_rad);
  if (!plane) return std::nullopt;
  const Edge low = find_edge(rgb, regions, camera, id, plane->first_in_image(), plane->down, kAnyGap);
  if (low.state != EdgeState::kSeen) return std::nullopt;
  const Edge high = find_edge(rgb, regions, camera, id, low.pixel - plane->down, -plane->down, kAnyGap);
  const auto foot = camera.ground(low.pixel.x(), low.pixel.y(), 50.0);
  if (high.state != EdgeState::kSeen || !foot) return std::nullopt;
  return Path{0.0, (*foot - camera.position_on_ground()).norm(), descent(camera, high.pixel)};
}

Few<Path, kPaths> walk_paths(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::size_t index,
                             const Sides& sides) {
  Few<Path, kPaths> paths;
  for (std::size_t i = 0; i < kPaths; ++i) {
    const double aside = (path_share(i, kPaths, kMiddle) - 0.5) * sides.angle_rad();
    auto path = walk(rgb, camera, regions, index, 0.5 * (sides.left_rad + sides.right_rad) + aside);
    if (!path) continue;
    path->aside_rad = aside;
    paths.push_back(*path);
  }
  return paths;
}

double lower_edge_range_m(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::uint8_t id,
                          double right_rad, double left_rad, double max_gap, bool& cut) {
  Few<double, kPaths> ranges;
  std::size_t lost = 0, cuts = 0;
  for (std::size_t i = 0; i < kPaths; ++i) {
    const auto plane = vertical_plane(camera, right_rad + path_share(i, kPaths, kInnerShare) * (left_rad - right_rad));
    if (!plane) continue;
    const Edge edge = find_edge(rgb, regions, camera, id, plane->first_in_image(), plane->down, max_gap);
    if (edge.state == EdgeState::kCut || edge.state == EdgeState::kHidden) ++lost;
    if (edge.state == EdgeState::kCut) ++cuts;
    if (edge.state != EdgeState::kSeen) continue;
    if (const auto p = camera.ground(edge.pixel.x(), edge.pixel.y(), 50.0)) {
      ranges.push_back((*p - camera.position_on_ground()).norm());
    }
  }
  cut = 2 * cuts > kPaths;
  if (ranges.empty() || lost > ranges.size()) return std::numeric_limits<double>::quiet_NaN();
  return upper_median(ranges);
}

Few<double, kPaths> upper_edge_slopes(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions,
                                      std::uint8_t id, double right_rad, double left_rad) {
  Few<double, kPaths> slopes;
  for (std::size_t i = 0; i < kPaths; ++i) {
    const auto plane = vertical_plane(camera, right_rad + path_share(i, kPaths, kInnerShare) * (left_rad - right_rad));
    if (!plane) continue;
    const Edge edge = find_edge(rgb, regions, camera, id, plane->horizon, -plane->down, kMaxGapPixels);
    if (edge.state == EdgeState::kSeen) slopes.push_back(-descent(camera, edge.pixel));
  }
  return slopes;
}

Disc Disc::between_tangents(double range_m, double angle_rad) {
  const double sine = std::sin(std::min(0.5 * angle_rad, 1.4));
  const double radius_m = range_m * sine / (1.0 - sine);
  return {range_m + radius_m, radius_m};
}

Disc Disc::of(const Sides& sides, const Few<Path, kPaths>& paths) {
  const auto nearer = [](const Path& a, const Path& b) { return a.near_m < b.near_m; };
  return between_tangents(std::min_element(paths.begin(), paths.end(), nearer)->near_m, sides.angle_rad());
}

double Disc::far_m(double aside_rad) const {
  const double across_m = centre_m * std::sin(aside_rad);
  return centre_m * std::cos(aside_rad) + std::sqrt(std::max(0.0, radius_m * radius_m - across_m * across_m));
}

}  // namespace constrictor::perception
