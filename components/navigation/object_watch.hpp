// What is known of the object and of the drop zone of each colour: seen or not, debounced over images, and where in the map.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cstdint>
#include <deque>

#include "constrictor/messages.hpp"
#include "navigation/pose2.hpp"

namespace constrictor {

/// A thing of one colour and kind, by the images so far.
struct Sighting {
  int seen = 0;               ///< images in a row that showed it
  int missed = 0;             ///< images in a row that did not
  bool visible = false;       ///< debounced
  bool known = false;         ///< a position was measured at least once
  double x_m = 0.0;           ///< [m] centre in M
  double y_m = 0.0;
  double radius_m = 0.0;      ///< [m] estimate
  double weight = 0.0;        ///< of the position's average; grows with images, fades with travel
  double bearing_rad = 0.0;   ///< in the newest image that showed it, in G
  double range_m = 0.0;       ///< to its nearest ground point there; NaN unknown
  std::int64_t seen_tick = -1;
  [[nodiscard]] Eigen::Vector2d p_M() const { return {x_m, y_m}; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seen, missed, visible, known, x_m, y_m, radius_m, weight, bearing_rad, range_m, seen_tick);
  }
};

struct ObjectWatchLimits {
  int found_after = 3;             ///< images
  int lost_after = 10;             ///< images
  double object_radius_m = 0.085;  ///< assumed until the image tells
  double min_radius_m = 0.06;
  double max_radius_m = 0.12;
  double zone_radius_m = 0.3;
  double jump_m = 0.5;             ///< a position farther than this from the average starts a new one
  double memory_images = 8.0;      ///< images over which a position is averaged
};

struct ObjectWatchState {
  std::array<Sighting, msg::kColourCount> objects;  ///< by colour
  std::array<Sighting, msg::kColourCount> zones;
  std::deque<std::array<double, 4>> poses;  ///< (tick, x, y, yaw) of the head in M, newest last
  template <class Archive>
  void serialize(Archive& archive) {
    archive(objects, zones, poses);
  }
};

/// Remembers the pose of this tick, so that an image can be placed where it was taken.
void remember_pose(std::int64_t tick, const Pose2& X_MH, ObjectWatchState& state);

/// Takes a new set of percepts. Of several blobs of one colour and kind the largest counts. An undecided blob counts as a sighting
/// of what is already known of its colour near there, but does not move its position.
void watch_objects(const ObjectWatchLimits& limits, const msg::ObjectPercepts& percepts, ObjectWatchState& state);

/// Pose of the head in M at a tick, by memory (the nearest remembered).
Pose2 remembered_pose(std::int64_t tick, const ObjectWatchState& state);

}  // namespace constrictor
