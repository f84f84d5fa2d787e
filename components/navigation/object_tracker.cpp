#include "navigation/object_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "robot/camera_mount.hpp"
#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kPosesKept = 40;

/// Radius from the image if it shows the whole width; otherwise the radius so far.
double measured_radius_m(const ObjectTrackerConfig& config, const msg::Blob& blob, const Sighting& s) {
  const bool whole = !blob.cut_left && !blob.cut_right && std::isfinite(blob.width_m) && blob.width_m > 0.0;
  const double before_m = s.radius_m > 0.0 ? s.radius_m : config.object_radius_m;
  if (!whole) return before_m;
  const double now_m = std::clamp(0.5 * blob.width_m, config.min_radius_m, config.max_radius_m);
  return before_m + 0.2 * (now_m - before_m);
}

void see(const ObjectTrackerConfig& config, const msg::Blob& blob, bool zone, const PlanarPose& X_MH, std::int64_t tick,
         Sighting& s) {
  s.seen_tick = tick;
  s.bearing_rad = blob.bearing_rad;
  s.range_m = blob.range_m;
  if (!zone) s.radius_m = measured_radius_m(config, blob, s);
  // If the image cuts the object at the bottom or at a side, the centre of the visible part is not the object's centre.
  const bool whole = !blob.cut_bottom && !blob.cut_left && !blob.cut_right;
  if (!std::isfinite(blob.range_m) || !std::isfinite(blob.bearing_rad) || (!whole && s.known)) return;
  double radius_m = s.radius_m;
  if (zone) {
    radius_m = std::isfinite(blob.width_m) && blob.width_m > 0.0 ? 0.5 * blob.width_m : config.zone_radius_m;
    radius_m = std::clamp(radius_m, 0.1, 0.6);
    s.radius_m = radius_m;
  }
  const double distance_m = blob.range_m + radius_m;
  const Eigen::Vector2d p_M =
      X_MH.to_parent({distance_m * std::cos(blob.bearing_rad), distance_m * std::sin(blob.bearing_rad)});
  if (!s.known || (p_M - s.p_M()).norm() > config.jump_m) s.weight = 0.0;
  s.weight = std::min(config.memory_images, s.weight + 1.0);
  s.x_m += (p_M.x() - s.x_m) / s.weight;
  s.y_m += (p_M.y() - s.y_m) / s.weight;
  s.known = true;
}

}  // namespace

void remember_pose(std::int64_t tick, const PlanarPose& X_MH, ObjectTrackerState& state) {
  state.poses.push_back({static_cast<double>(tick), X_MH.p.x(), X_MH.p.y(), X_MH.yaw_rad});
  while (state.poses.size() > kPosesKept) state.poses.pop_front();
}

PlanarPose remembered_pose(std::int64_t tick, const ObjectTrackerState& state) {
  PlanarPose pose;
  double nearest = 1e18;
  for (const auto& [at, x_m, y_m, yaw_rad] : state.poses) {
    const double distance = std::abs(at - static_cast<double>(tick));
    if (distance > nearest) continue;
    nearest = distance;
    pose.p = {x_m, y_m};
    pose.yaw_rad = yaw_rad;
  }
  return pose;
}

void update_object_tracker(const ObjectTrackerConfig& config, const msg::ObjectPercepts& percepts,
                           ObjectTrackerState& state) {
  const PlanarPose X_MH = remembered_pose(percepts.exposure_tick, state);
  std::array<const msg::Blob*, msg::kColourCount> object{};
  std::array<const msg::Blob*, msg::kColourCount> zone{};
  for (std::size_t i = 0; i < percepts.blob_count; ++i) {
    const msg::Blob& blob = percepts.blobs[i];
    if (blob.colour >= msg::kColourCount) continue;
    const bool flat = blob.kind == msg::kBlobZone;
    const bool undecided = blob.kind == msg::kBlobUndecided;
    auto keep = [&blob](const msg::Blob*& best) {
      if (!best || blob.area_fraction > best->area_fraction) best = &blob;
    };
    if (blob.kind == msg::kBlobObject || (undecided && state.objects[blob.colour].visible)) keep(object[blob.colour]);
    if (flat || (undecided && state.zones[blob.colour].visible)) keep(zone[blob.colour]);
  }
  for (std::size_t colour = 0; colour < msg::kColourCount; ++colour) {
    auto take = [&](const msg::Blob* blob, bool flat, Sighting& s) {
      debounce(config, blob != nullptr, s);
      if (blob) see(config, *blob, flat, X_MH, percepts.exposure_tick, s);
    };
    take(object[colour], false, state.objects[colour]);
    take(zone[colour], true, state.zones[colour]);
  }
}

double seen_height_m(const RobotModel& robot, const msg::Blob& blob) {
  if (!std::isfinite(blob.range_m) || !std::isfinite(blob.bearing_rad)) return 0.0;
  const CameraModel& camera = robot.camera;
  const double focal = 0.5 * camera.width / std::tan(0.5 * camera.horizontal_fov_rad);
  const double u = 0.5 * (blob.u_min + blob.u_max + 1);
  const Eigen::Vector3d top_C((u - 0.5 * camera.width) / focal, (blob.v_min - 0.5 * camera.height) / focal, 1.0);
  const Eigen::Vector3d top_H = camera_mount(camera).linear() * top_C;
  const double slope = top_H.z() / top_H.head<2>().norm();
  const Eigen::Vector2d foot(blob.range_m * std::cos(blob.bearing_rad), blob.range_m * std::sin(blob.bearing_rad));
  const double near_m = (foot - camera.p_HC.head<2>()).norm();
  // A camera above the object sees the far rim of its top as the highest edge, one below it the near rim.
  const bool above = slope < 0.0;
  const double depth_m = above && std::isfinite(blob.width_m) ? std::max(0.0, blob.width_m) : 0.0;
  return std::max(0.0, robot.module_radius_m + camera.p_HC.z() + (near_m + depth_m) * slope);
}

void measure_heights(const RobotModel& robot, const msg::ObjectPercepts& percepts, ObjectTrackerState& state) {
  std::array<const msg::Blob*, msg::kColourCount> largest{};
  for (std::size_t i = 0; i < percepts.blob_count; ++i) {
    const msg::Blob& blob = percepts.blobs[i];
    if (blob.colour >= msg::kColourCount || blob.kind != msg::kBlobObject || blob.cut_bottom) continue;
    const msg::Blob*& best = largest[blob.colour];
    if (!best || blob.area_fraction > best->area_fraction) best = &blob;
  }
  for (std::size_t colour = 0; colour < msg::kColourCount; ++colour) {
    if (!largest[colour]) continue;
    Sighting& s = state.objects[colour];
    const double now_m = seen_height_m(robot, *largest[colour]);
    if (now_m <= 0.0) continue;
    if (largest[colour]->cut_top) s.height_m = std::max(s.height_m, now_m);
    else s.height_m += (s.height_m > 0.0 ? 0.1 : 1.0) * (now_m - s.height_m);
  }
}

void forget_dropped(const ObjectTrackerConfig& config, const msg::FieldMap& map, ObjectTrackerState& state) {
  const auto forget = [&](std::uint8_t colour, std::uint8_t kind, Sighting& s) {
    if (!s.known) return;
    const auto* there = nearest_landmark(map, colour, kind, s.x_m, s.y_m);
    const bool mapped = there && std::hypot(there->x_m - s.x_m, there->y_m - s.y_m) < config.jump_m;
    if (mapped) {
      s.handle = there->handle;
      return;
    }
    const auto landmarks = landmarks_of(map);
    const bool exists = std::any_of(landmarks.begin(), landmarks.end(),
                                    [&](const msg::MapObject& landmark) { return landmark.handle == s.handle; });
    if (s.handle == 0 || exists || s.visible) return;
    s.known = false;
    s.weight = 0.0;
    s.handle = 0;
  };
  for (std::uint8_t colour = 0; colour < msg::kColourCount; ++colour) {
    forget(colour, msg::kBlobObject, state.objects[colour]);
    forget(colour, msg::kBlobZone, state.zones[colour]);
  }
}

}  // namespace constrictor
