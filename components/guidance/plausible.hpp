// Rejects messages that no robot can produce. Guidance integrates its inputs: a single absurd value, finite or not,
// would spoil its estimates for the rest of the run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "constrictor/messages.hpp"

namespace constrictor::guidance {

/// True if every value lies from -bound to bound. False if a value is NaN.
inline bool all_within(const double* values, std::size_t count, double bound) {
  return std::all_of(values, values + count, [bound](double v) { return std::abs(v) <= bound; });
}

// Each function returns a text that names the wrong field and the accepted values; null if the message is plausible.

/// The robot has `count` joints. No angle may exceed a full turn, no rate the speed of any servo.
inline const char* implausible(const msg::JointState& joints, std::size_t count) {
  if (joints.joint_count != count) return "joint_count: not this robot's";
  if (!all_within(joints.position_rad, count, 6.3)) return "position_rad: accepted -6.3 to 6.3";
  if (!all_within(joints.velocity_rad_s, count, 100.0)) return "velocity_rad_s: accepted -100 to 100";
  return nullptr;
}

/// No force may be greater than one that would break the robot.
inline const char* implausible(const msg::ContactState& contacts) {
  const auto bounded = [](const msg::Vector3& f) {
    return std::abs(f.x) <= 1e4 && std::abs(f.y) <= 1e4 && std::abs(f.z) <= 1e4;
  };
  const std::size_t modules = std::min<std::size_t>(contacts.module_count, msg::kMaxModules);
  const std::size_t touches = std::min<std::size_t>(contacts.contact_count, msg::kMaxContacts);
  if (!std::all_of(contacts.force_n, contacts.force_n + modules, bounded)) return "force_n: accepted -1e4 to 1e4";
  if (!std::all_of(contacts.contacts, contacts.contacts + touches, [&](const msg::Contact& c) {
        return bounded(c.force_n) && std::abs(c.position_m.x) <= 1.0 && std::abs(c.position_m.y) <= 1.0;
      })) {
    return "contacts: accepted forces of -1e4 to 1e4 N within 1 m of the module";
  }
  return nullptr;
}

/// The orientation must be a unit quaternion, with some tolerance.
inline const char* implausible(const msg::ImuState& imu) {
  const auto& q = imu.orientation;
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return square > 0.5 && square < 2.0 ? nullptr : "orientation: accepted a unit quaternion";
}

/// NaN means "unknown". Known distances are limited; close to the horizon, distances are large and inaccurate.
inline bool in_sight(double value) { return std::isnan(value) || std::abs(value) <= 1e4; }

/// A camera is at most as far from the head as the longest robot is long.
inline bool on_robot(const msg::Pose2& X_GV) {
  return std::abs(X_GV.x_m) <= 100.0 && std::abs(X_GV.y_m) <= 100.0 && std::abs(X_GV.yaw_rad) <= 6.3;
}

inline const char* implausible(const msg::LinePercept& line) {
  if (!on_robot(line.X_GV)) return "X_GV: accepted -100 to 100 m and -6.3 to 6.3 rad";
  const std::size_t points = std::min<std::size_t>(line.point_count, std::size(line.x_m));
  const bool seen = in_sight(line.end_distance_m) && in_sight(line.lookahead_m) && in_sight(line.offset_m) &&
                    in_sight(line.heading_rad) && in_sight(line.curvature_1_m) && in_sight(line.near_m) &&
                    in_sight(line.far_m) && std::all_of(line.x_m, line.x_m + points, in_sight) &&
                    std::all_of(line.y_m, line.y_m + points, in_sight);
  return seen ? nullptr : "a number: accepted NaN and -1e4 to 1e4";
}

inline const char* implausible(const msg::ObjectPercepts& objects) {
  if (!on_robot(objects.X_GV)) return "X_GV: accepted -100 to 100 m and -6.3 to 6.3 rad";
  const std::size_t count = std::min<std::size_t>(objects.blob_count, std::size(objects.blobs));
  const bool seen = std::all_of(objects.blobs, objects.blobs + count, [](const msg::Blob& blob) {
    return in_sight(blob.bearing_rad) && in_sight(blob.range_m) && in_sight(blob.width_m) && in_sight(blob.height_m);
  });
  if (!seen) return "blobs: accepted NaN and -1e4 to 1e4";
  const std::size_t obstacles = std::min<std::size_t>(objects.obstacle_count, std::size(objects.obstacle_x_m));
  const bool placed =
      all_within(objects.obstacle_x_m, obstacles, 1e4) && all_within(objects.obstacle_y_m, obstacles, 1e4);
  return placed ? nullptr : "obstacle_x_m, obstacle_y_m: accepted -1e4 to 1e4";
}

}  // namespace constrictor::guidance
