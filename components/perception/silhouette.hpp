// The outline of a region: its sides, its lowest and its highest edge along lines of sight, and the disc on the ground
// that sides and lowest edge belong to.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "perception/few.hpp"
#include "perception/ground_camera.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

/// Number of lines of sight along which an edge is searched.
inline constexpr std::size_t kPaths = 9;
/// Share of an object's width over which these lines are spread if its lower or upper edge gives the range.
inline constexpr double kInnerShare = 0.5;
/// [pixel] widest hole in the standing part of a region that a walk passes over.
inline constexpr double kMaxGapPixels = 3.0;

/// The sides of a region: its greatest and least azimuth.
struct Sides {
  double left_rad = -1e9, right_rad = 1e9;
  double nearest_m = 0.0;                          ///< distance of the lowest row in view
  bool left_hidden = false, right_hidden = false;  ///< something, or the robot's body, hides this side
  [[nodiscard]] double angle_rad() const { return left_rad - right_rad; }
  [[nodiscard]] double middle_rad() const { return 0.5 * (left_rad + right_rad); }
};

/// `rgb` is the smoothed image.
[[nodiscard]] Sides sides_of(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions, std::size_t index);

/// The result of a line of sight through a region.
struct Path {
  double aside_rad = 0.0;  ///< from the middle azimuth
  double near_m = 0.0;     ///< distance of the lowest edge on the ground
  double slope = 0.0;      ///< of the line of sight to the highest edge, positive downwards
};

/// None if the border of the image, or something else, hides one of the two edges.
[[nodiscard]] std::optional<Path> walk(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions,
                                       std::size_t index, double azimuth_rad);

/// Up to kPaths paths, spread over the middle of the region.
[[nodiscard]] Few<Path, kPaths> walk_paths(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions,
                                           std::size_t index, const Sides& sides);

/// [m] horizontal distance of the lower edge of a region from the camera, in the middle between two azimuths; NaN if it
/// is cut or hidden. `max_gap`: as for find_edge(). `cut`: the border of the image or the robot's own body cuts it.
[[nodiscard]] double lower_edge_range_m(const cv::Mat& rgb, const GroundCamera& camera, const Regions& regions,
                                        std::uint8_t id, double right_rad, double left_rad, double max_gap, bool& cut);

/// Slopes of the lines of sight to the edge of a region above the horizon, positive upwards, in the middle between two
/// azimuths; empty if the edge is cut or hidden.
[[nodiscard]] Few<double, kPaths> upper_edge_slopes(const cv::Mat& rgb, const GroundCamera& camera,
                                                    const Regions& regions, std::uint8_t id, double right_rad,
                                                    double left_rad);

/// A disc on the ground, seen from the camera. Distances are from the point below the camera.
struct Disc {
  double centre_m = 0.0;
  double radius_m = 0.0;

  /// The disc whose nearest point is at `range_m`, and which fills an angle between its tangents.
  static Disc between_tangents(double range_m, double angle_rad);
  /// The disc to which the sides and the nearest edge of a region belong; `paths` must not be empty.
  static Disc of(const Sides& sides, const Few<Path, kPaths>& paths);
  /// [m] distance of its farthest point at an angle beside its centre.
  [[nodiscard]] double far_m(double aside_rad) const;
};

}  // namespace constrictor::perception
