// What guidance believes of its inputs. Its estimates integrate them: one absurd value, finite or not, would stay for ever.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "constrictor/messages.hpp"

namespace constrictor::guidance {

/// True if each of the values lies within ±bound. NaN does not.
inline bool all_within(const double* values, std::size_t count, double bound) {
  return std::all_of(values, values + count, [bound](double v) { return std::abs(v) <= bound; });
}

/// The first `count` joints: no angle beyond a turn, no rate that no servo reaches.
inline bool plausible(const msg::JointState& joints, std::size_t count) {
  constexpr double kMost_rad = 6.3;
  constexpr double kMost_rad_s = 100.0;
  return joints.joint_count == count && all_within(joints.position_rad, count, kMost_rad) &&
         all_within(joints.velocity_rad_s, count, kMost_rad_s);
}

/// No force that would break the robot.
inline bool plausible(const msg::ContactState& contacts) {
  constexpr double kMost_n = 1e4;
  const auto bounded = [](const msg::Vector3& f) { return std::max({std::abs(f.x), std::abs(f.y), std::abs(f.z)}) <= kMost_n; };
  const std::size_t modules = std::min<std::size_t>(contacts.module_count, msg::kMaxModules);
  const std::size_t touches = std::min<std::size_t>(contacts.contact_count, msg::kMaxContacts);
  return std::all_of(contacts.force_n, contacts.force_n + modules, bounded) &&
         std::all_of(contacts.contacts, contacts.contacts + touches, [&](const msg::Contact& c) {
           return bounded(c.force_n) && std::abs(c.position_m.x) <= 1.0 && std::abs(c.position_m.y) <= 1.0;
         });
}

/// A unit quaternion, nearly.
inline bool plausible(const msg::ImuState& imu) {
  const auto& q = imu.orientation;
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return square > 0.5 && square < 2.0;
}

/// NaN says "unknown"; what is known lies within sight (at the horizon distances grow without meaning much).
inline bool in_sight(double value) { return std::isnan(value) || std::abs(value) <= 1e4; }

inline bool plausible(const msg::LinePercept& line) {
  const std::size_t points = std::min<std::size_t>(line.point_count, std::size(line.x_m));
  return in_sight(line.end_distance_m) && in_sight(line.lookahead_m) && in_sight(line.offset_m) && in_sight(line.heading_rad) &&
         in_sight(line.curvature_1_m) && in_sight(line.near_m) && in_sight(line.far_m) && std::all_of(line.x_m, line.x_m + points, in_sight) &&
         std::all_of(line.y_m, line.y_m + points, in_sight);
}

inline bool plausible(const msg::ObjectPercepts& objects) {
  const std::size_t count = std::min<std::size_t>(objects.blob_count, std::size(objects.blobs));
  return std::all_of(objects.blobs, objects.blobs + count, [](const msg::Blob& blob) {
    return in_sight(blob.bearing_rad) && in_sight(blob.range_m) && in_sight(blob.width_m);
  });
}

}  // namespace constrictor::guidance
