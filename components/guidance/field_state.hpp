// The map as guidance keeps it. Plain data, serialisable.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <deque>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::guidance {

/// An object or zone. The pose filter keeps its place; while the robot carries the object, this struct keeps its place.
struct Landmark {
  std::uint16_t handle = 0;
  std::uint8_t colour = 0;
  std::uint8_t kind = 0;
  std::int32_t slot = -1;  ///< number of the landmark in the pose filter; -1: the filter does not keep it
  double x_m = 0.0, y_m = 0.0, sd_m = 0.0;  ///< position in M and its standard deviation; valid while slot is -1
  double radius_m = 0.0;                    ///< running mean; 0: unknown
  double height_m = 0.0;                    ///< the same, of an object
  std::int32_t hits = 0;                    ///< number of percepts of this landmark; counting stops at 1000
  std::int32_t strays = 0;                  ///< number of successive percepts that showed the landmark at another place
  double log_odds = 0.0;                    ///< natural logarithm of the odds that it exists
  double object_log_odds = 0.0;             ///< the same of the odds that it is an object and no zone
  bool felt = false;
  bool carried = false;
  bool may_have_moved = false;  ///< it was released or touched, and not seen since
  std::int64_t last_seen_tick = 0;
  std::int64_t proved_tick = -1;  ///< when an image last raised log_odds; the cameras expose at the same ticks
  template <class Archive>
  void serialize(Archive& archive) {
    archive(handle, colour, kind, slot, x_m, y_m, sd_m, radius_m, height_m, hits, strays, log_odds, object_log_odds,
            felt, carried, may_have_moved, last_seen_tick, proved_tick);
  }
};

/// A contact of the robot with something other than the ground and itself. Positions are in M.
struct Felt {
  double x_m = 0.0, y_m = 0.0, force_n = 0.0;
  std::uint8_t module_index = 0;
  std::int64_t tick = 0;
  std::uint16_t handle = 0;  ///< of the object that stands there; 0: an obstacle
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, force_n, module_index, tick, handle);
  }
};

/// A point on the surface of an obstacle.
struct Obstacle {
  double x_m = 0.0, y_m = 0.0;  ///< in M
  double sd_m = 0.0;            ///< standard deviation along the line of sight
  std::int32_t hits = 0;        ///< number of images that showed it
  std::int32_t misses = 0;      ///< number of successive images that should have shown it
  bool felt = false;
  std::int64_t last_seen_tick = 0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, sd_m, hits, misses, felt, last_seen_tick);
  }
};

struct FieldState {
  std::vector<Landmark> landmarks;
  std::uint16_t next_handle = 1;
  bool carrying = false;
  std::uint8_t line_colour = 0;
  std::vector<double> line_x_m, line_y_m;                    ///< points in M, in the order of their discovery
  std::vector<std::int64_t> line_tick;                       ///< tick of each discovery
  std::deque<Felt> felt;                                     ///< the oldest first
  std::vector<Obstacle> obstacles;                           ///< the oldest first
  std::array<std::int64_t, msg::kMaxCameras> looked_tick{};  ///< of the newest percepts of each camera
  template <class Archive>
  void serialize(Archive& archive) {
    archive(landmarks, next_handle, carrying, line_colour, line_x_m, line_y_m, line_tick, felt, obstacles, looked_tick);
  }
};

}  // namespace constrictor::guidance
