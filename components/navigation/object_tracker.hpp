// The object and the drop zone of each colour as navigation sees them: visible or not, debounced over images, and their
// positions in the map.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cstdint>
#include <deque>

#include "constrictor/messages.hpp"
#include "navigation/debounce.hpp"
#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// The object, or the drop zone, of one colour as seen so far.
struct Sighting : Visibility {
  bool known = false;  ///< its position was measured at least once
  double x_m = 0.0;    ///< centre in M
  double y_m = 0.0;
  double radius_m = 0.0;     ///< estimate
  double height_m = 0.0;     ///< estimate, of an object; 0: no image has shown its top yet
  double weight = 0.0;       ///< number of images in the average of the position, limited to memory_images
  double bearing_rad = 0.0;  ///< in the newest image that showed it, in frame G
  double range_m = 0.0;      ///< to its nearest ground point in that image; NaN: unknown
  std::int64_t seen_tick = -1;
  std::uint16_t handle = 0;  ///< of the map's landmark there; 0: the map has none, or had none yet
  [[nodiscard]] Eigen::Vector2d p_M() const { return {x_m, y_m}; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seen, missed, visible, known, x_m, y_m, radius_m, height_m, weight, bearing_rad, range_m, seen_tick,
            handle);
  }
};

struct ObjectTrackerConfig : DebounceConfig {
  ObjectTrackerConfig() : DebounceConfig("An object") {}
  double object_radius_m = add(object_radius_m, "object_radius_m", 0.085, "m", {0.0, 10.0}, kAtStart,
                               "Radius of an object until an image shows its whole width");
  double min_radius_m =
      add(min_radius_m, "min_radius_m", 0.03, "m", {0.0, 10.0}, kAtStart, "Smallest radius of an object");
  double max_radius_m =
      add(max_radius_m, "max_radius_m", 0.2, "m", {0.0, 10.0}, kAtStart, "Largest radius of an object");
  double zone_radius_m = add(zone_radius_m, "zone_radius_m", 0.3, "m", {0.0, 10.0}, kAtStart,
                             "Radius of a zone until an image shows its whole width");
  double jump_m = add(jump_m, "jump_m", 0.5, "m", {0.0, 10.0}, kWhileRunning,
                      "An object seen farther than this from its averaged position has been moved");
  double memory_images = add(memory_images, "memory_images", 8.0, "images", {1.0, 1000.0}, kAtStart,
                             "Number of images over which a position is averaged");
};

struct ObjectTrackerState {
  std::array<Sighting, msg::kColourCount> objects;  ///< by colour
  std::array<Sighting, msg::kColourCount> zones;
  std::deque<std::array<double, 4>> poses;  ///< (tick, x, y, yaw) of the head in M, newest last
  template <class Archive>
  void serialize(Archive& archive) {
    archive(objects, zones, poses);
  }
};

/// Stores the pose of this tick, so that a later percept can be placed from where its image was taken.
void remember_pose(std::int64_t tick, const PlanarPose& X_MH, ObjectTrackerState& state);

/// Takes a new set of percepts. Of several blobs of one colour and kind the largest counts. An undecided blob counts
/// for the object, and for the zone, of its colour that is visible already.
void update_object_tracker(const ObjectTrackerConfig& config, const msg::ObjectPercepts& percepts,
                           ObjectTrackerState& state);

/// [m] height of the upright object of this blob. If the image cuts its top off, this is a lower bound. 0: the range is
/// unknown. The error is that of the head's pitch, 0.02 m for a degree at 1 m.
[[nodiscard]] double seen_height_m(const RobotModel& robot, const msg::Blob& blob);

/// Averages the heights of the objects over the images, for the blobs that update_object_tracker takes for them.
void measure_heights(const RobotModel& robot, const msg::ObjectPercepts& percepts, ObjectTrackerState& state);

/// Discards the places of objects and zones that the map has given up: their landmark is gone, and the map has no other
/// one there.
void forget_dropped(const ObjectTrackerConfig& config, const msg::FieldMap& map, ObjectTrackerState& state);

/// Pose of the head in M at a tick: the stored pose of the nearest tick.
PlanarPose remembered_pose(std::int64_t tick, const ObjectTrackerState& state);

}  // namespace constrictor
