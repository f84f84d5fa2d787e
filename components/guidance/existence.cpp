#include "guidance/existence.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor::guidance {
namespace {

/// [rad] half of the angle under which a disc is seen from the camera.
double half_angle_rad(double radius_m, double distance_m) {
  return std::asin(std::clamp(radius_m / std::max(distance_m, 1e-6), 0.0, 1.0));
}

/// A direction from the camera and a half angle about it.
struct Sector {
  double bearing_rad, half_rad;
  [[nodiscard]] bool overlaps(const Sector& other) const {
    return std::abs(wrap_angle(bearing_rad - other.bearing_rad)) < half_rad + other.half_rad;
  }
};

/// The direction of a blob from the head's centre is also that from the camera to within the margins of this file.
Sector sector_of(const msg::Blob& blob) {
  constexpr double kUnknown_rad = 0.5;
  const bool sized = std::isfinite(blob.range_m) && std::isfinite(blob.width_m);
  return {blob.bearing_rad, sized ? std::atan2(0.5 * blob.width_m, blob.range_m) : kUnknown_rad};
}

/// Whether the image of a further camera has rows for the ground between two distances.
bool rows_in_view(const ExistenceConfig& config, const View& view, double near_m, double far_m, double bearing_rad) {
  if (view.height_m <= 0.0) return true;
  const double c = std::cos(view.camera.tilt_rad), s = std::sin(view.camera.tilt_rad);
  const double limit = 0.5 * view.camera.height / view.camera.focal_pixels() - config.margin_rad;
  const double ahead = std::cos(bearing_rad);
  const auto in_view = [&](double range_m) {
    const double x_m = range_m * ahead;
    const double depth_m = x_m * c + view.height_m * s;
    return depth_m > 0.0 && std::abs(view.height_m * c - x_m * s) < limit * depth_m;
  };
  return in_view(near_m) && in_view(far_m);
}

/// Whether a screen is so high, or stands so far away, that it reaches the line of sight to a foot at `near_m`.
bool reaches_sight(const View& view, const Disc& screen, double near_m) {
  if (view.height_m <= 0.0) return true;
  const double behind_m = (screen.p - view.p_VC).norm() + screen.radius_m;
  return screen.height_m > view.height_m * (1.0 - behind_m / near_m);
}

}  // namespace

double updated_log_odds(const ExistenceConfig& config, double log_odds, bool seen, double looks) {
  const double p_d = config.detection_probability, p_f = config.false_alarm_probability;
  const double evidence = seen ? std::log(p_d / p_f) : std::log((1.0 - p_d) / (1.0 - p_f));
  const double bound = std::log(config.most / (1.0 - config.most));
  return std::min(bound, log_odds + looks * evidence);
}

double log_odds_of(double probability) {
  constexpr double kLeast = 0.01;
  const double p = std::clamp(probability, kLeast, 1.0 - kLeast);
  return std::log(p / (1.0 - p));
}

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

bool clearly_in_view(const ExistenceConfig& config, const View& view, const Disc& landmark, std::uint8_t colour) {
  const CameraModel& camera = view.camera;
  const Eigen::Vector2d d = landmark.p - view.p_VC;
  const double distance_m = d.norm(), near_m = distance_m - landmark.radius_m;
  if (near_m < config.min_range_m || near_m + 2.0 * landmark.sd_m > config.max_range_m) return false;
  const Sector sector{std::atan2(d.y(), d.x()),
                      half_angle_rad(landmark.radius_m, distance_m) + 2.0 * landmark.sd_m / distance_m};
  if (std::abs(sector.bearing_rad) + sector.half_rad + config.margin_rad > 0.5 * camera.horizontal_fov_rad)
    return false;
  if (!rows_in_view(config, view, near_m, distance_m + landmark.radius_m, sector.bearing_rad)) return false;
  const Sector wide{sector.bearing_rad, sector.half_rad + config.margin_rad};
  const int count = std::min<int>(view.percepts.blob_count, msg::kMaxBlobs);
  for (int i = 0; i < count; ++i) {
    const msg::Blob& blob = view.percepts.blobs[i];
    if (!std::isfinite(blob.bearing_rad) || !wide.overlaps(sector_of(blob))) continue;
    const bool behind = std::isfinite(blob.range_m) && blob.range_m > distance_m + landmark.radius_m;
    if (blob.colour == colour || (blob.kind != msg::kBlobZone && !behind)) return false;
  }
  return std::none_of(view.screens.begin(), view.screens.end(), [&](const Disc& screen) {
    const Eigen::Vector2d s = screen.p - view.p_VC;
    const double screen_m = s.norm();
    const Sector hidden{std::atan2(s.y(), s.x()), half_angle_rad(screen.radius_m + screen.sd_m, screen_m)};
    return screen_m < distance_m + landmark.radius_m && wide.overlaps(hidden) && reaches_sight(view, screen, near_m);
  });
}

}  // namespace constrictor::guidance
