// Where the obstacles of the map leave room for the robot.
#pragma once

#include <Eigen/Core>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Whether no obstacle of the map is nearer than `room_m` to the straight way from one point of M to another. Obstacles
/// beside or behind the beginning do not count, because the way leads away from them.
[[nodiscard]] bool is_free_way(const msg::FieldMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               double room_m);

/// The same for the surfaces of the objects of the map, except for the one that is held.
[[nodiscard]] bool is_free_of_objects(const msg::FieldMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                      double room_m);

/// Whether an obstacle of the map is nearer than `room_m` to the arms of the U: between the held object and the head,
/// or less than `ahead_m` before the head. A robot that drives on, or turns, then catches on the obstacle.
[[nodiscard]] bool is_caught(const msg::FieldMap& map, const msg::MapObject& held, const Eigen::Vector2d& head,
                             double room_m, double ahead_m);

}  // namespace constrictor
