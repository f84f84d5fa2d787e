// The pieces of which Foxglove's messages are made.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "constrictor/colours.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::views {

inline nlohmann::json stamp(std::uint64_t time_ns) {
  return {{"sec", time_ns / 1'000'000'000}, {"nsec", time_ns % 1'000'000'000}};
}

inline nlohmann::json point(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }

inline nlohmann::json pose_of(double x, double y, double z, double yaw_rad = 0) {
  return {{"position", point(x, y, z)},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(yaw_rad / 2)}, {"w", std::cos(yaw_rad / 2)}}}};
}

inline nlohmann::json pose_of(const msg::Pose3& pose) {
  const auto& q = pose.orientation;
  return {{"position", point(pose.position_m.x, pose.position_m.y, pose.position_m.z)},
          {"orientation", {{"x", q.x}, {"y", q.y}, {"z", q.z}, {"w", q.w}}}};
}

inline nlohmann::json colour(double r, double g, double b, double a = 1) {
  return {{"r", r}, {"g", g}, {"b", b}, {"a", a}};
}

inline nlohmann::json colour_of(std::uint8_t named, double alpha = 1) {
  const Rgb8& screen = look_of(named).screen;
  return colour(screen[0] / 255.0, screen[1] / 255.0, screen[2] / 255.0, alpha);
}

}  // namespace constrictor::views
