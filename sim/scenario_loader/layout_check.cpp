#include "sim/scenario_loader/layout_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace constrictor {
namespace {

using Eigen::Vector2d;

/// The footprint of an upright solid: a disc or a rectangle.
struct Footprint {
  std::string name;
  bool disc = true;
  Vector2d centre{0.0, 0.0};
  double radius = 0.0;
  Vector2d half{0.0, 0.0};
  double yaw = 0.0;

  [[nodiscard]] Vector2d to_local(const Vector2d& p) const {
    const Vector2d d = p - centre;
    return {std::cos(yaw) * d.x() + std::sin(yaw) * d.y(), -std::sin(yaw) * d.x() + std::cos(yaw) * d.y()};
  }
  [[nodiscard]] std::array<Vector2d, 4> corners() const {
    std::array<Vector2d, 4> result;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d p(i & 1U ? half.x() : -half.x(), i & 2U ? half.y() : -half.y());
      result[i] = centre + Vector2d(std::cos(yaw) * p.x() - std::sin(yaw) * p.y(),
                                    std::sin(yaw) * p.x() + std::cos(yaw) * p.y());
    }
    return result;
  }
};

Footprint footprint(std::string name, BodyShape shape, const Eigen::Vector3d& size, const Vector2d& at, double yaw) {
  return {std::move(name), shape == BodyShape::kCylinder, at, size.x(), 0.5 * size.head<2>(), yaw};
}

/// [m] from a point to a rectangle; 0 inside it.
double distance_m(const Footprint& rectangle, const Vector2d& point) {
  const Vector2d p = rectangle.to_local(point);
  return (p - p.cwiseMax(-rectangle.half).cwiseMin(rectangle.half)).norm();
}

bool rectangle_hits_disc(const Footprint& rectangle, const Footprint& disc) {
  return distance_m(rectangle, disc.centre) < disc.radius;
}

/// Two rectangles do not overlap if the sides of one of them separate them (separating axis theorem).
bool rectangles_hit(const Footprint& a, const Footprint& b) {
  for (const auto& [one, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    Vector2d low = Vector2d::Constant(INFINITY);
    Vector2d high = Vector2d::Constant(-INFINITY);
    for (const Vector2d& corner : other->corners()) {
      const Vector2d p = one->to_local(corner);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if ((low.array() >= one->half.array()).any() || (high.array() <= -one->half.array()).any()) return false;
  }
  return true;
}

Footprint footprint_of(const Scenario& scenario, std::size_t obstacle) {
  const ScenarioObstacle& one = scenario.obstacles[obstacle];
  return footprint(fmt::format("obstacles[{}]", obstacle), one.shape, one.size_m, one.position_m, one.yaw_rad);
}

bool overlap(const Footprint& a, const Footprint& b) {
  if (a.disc && b.disc) return (a.centre - b.centre).norm() < a.radius + b.radius;
  if (a.disc) return rectangle_hits_disc(b, a);
  if (b.disc) return rectangle_hits_disc(a, b);
  return rectangles_hit(a, b);
}

}  // namespace

std::string find_overlap(const Scenario& scenario, double body_length_m, double body_half_width_m) {
  std::vector<Footprint> moving;  // no two of these footprints may overlap
  const Vector2d forward(std::cos(scenario.start_yaw_rad), std::sin(scenario.start_yaw_rad));
  // The robot's footprint reaches from 0.1 m ahead of the centre of the head to 0.1 m behind the tail.
  Footprint robot{"the robot's body at the start",
                  false,
                  scenario.start_m - 0.5 * body_length_m * forward,
                  0.0,
                  Vector2d(0.5 * body_length_m + 0.1, body_half_width_m),
                  scenario.start_yaw_rad};
  moving.push_back(robot);
  for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
    const ScenarioObject& object = scenario.objects[i];
    moving.push_back(
        footprint(fmt::format("objects[{}]", i), object.shape, object.size_m, object.position_m, object.yaw_rad));
  }
  for (std::size_t i = 0; i < moving.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(moving[i], moving[j])) return moving[i].name + " overlaps " + moving[j].name;
    }
    for (std::size_t j = 0; j < scenario.obstacles.size(); ++j) {
      const Footprint fixed = footprint_of(scenario, j);
      if (overlap(moving[i], fixed)) return moving[i].name + " overlaps " + fixed.name;
    }
  }
  return {};
}

std::vector<std::string> find_obstacles_on_line(const Scenario& scenario, double body_half_width_m) {
  std::vector<std::string> found;
  for (std::size_t j = 0; j < scenario.obstacles.size(); ++j) {
    const Footprint obstacle = footprint_of(scenario, j);
    double along_m = 0.0;
    for (std::size_t i = 0; i < scenario.line_m.size(); ++i) {
      const Vector2d& point = scenario.line_m[i];
      if (i > 0) along_m += (point - scenario.line_m[i - 1]).norm();
      const double apart_m =
          obstacle.disc ? (point - obstacle.centre).norm() - obstacle.radius : distance_m(obstacle, point);
      if (apart_m >= body_half_width_m) continue;
      found.push_back(
          fmt::format("{} stands on the line, {:.2f} m from its beginning: the robot cannot follow the line "
                      "there",
                      obstacle.name, along_m));
      break;
    }
  }
  return found;
}

std::vector<std::string> find_turns_back(const Scenario& scenario) {
  constexpr double kApart_m = 1.5;  // with 1.6 m, six of six missions followed the line; with 1.2 m, four
  constexpr double kOpposite_rad = 2.8;
  constexpr double kBend_m = 0.8, kBend_rad = 1.95;  // 120 degrees within 0.63 m: seven of eight; within 0.84 m: all
  const auto& line = scenario.line_m;
  if (line.size() < 3) return {};
  std::vector<double> along_m{0.0};
  std::vector<Vector2d> direction;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d step = line[i] - line[i - 1];
    along_m.push_back(along_m.back() + step.norm());
    direction.push_back(step.normalized());
  }
  double nearest_m = kApart_m, from_m = 0.0, to_m = 0.0;
  for (std::size_t i = 0; i < direction.size(); ++i) {
    for (std::size_t j = i + 1; j < direction.size(); ++j) {
      const double turn_rad = std::acos(std::clamp(direction[i].dot(direction[j]), -1.0, 1.0));
      if (turn_rad > kBend_rad && along_m[j] - along_m[i] < kBend_m) {
        return {
            fmt::format("line.segments: the line turns by more than {:.0f} degrees within {:.1f} m of its length, "
                        "{:.2f} m from its beginning: the robot may lose it there",
                        kBend_rad * 180.0 / std::numbers::pi, kBend_m, along_m[i])};
      }
      const double apart_m = (line[i] - line[j]).norm();
      if (turn_rad < kOpposite_rad || apart_m >= nearest_m) continue;
      nearest_m = apart_m;
      from_m = along_m[i];
      to_m = along_m[j];
    }
  }
  if (nearest_m >= kApart_m) return {};
  return {
      fmt::format("line.segments: the line runs back beside itself, {:.2f} m apart ({:.2f} m and {:.2f} m from its "
                  "beginning), accepted {} m or more: the robot may lose it in the bend, or follow it the wrong way",
                  nearest_m, from_m, to_m, kApart_m)};
}

}  // namespace constrictor
