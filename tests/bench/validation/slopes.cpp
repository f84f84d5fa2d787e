// Bodies on a slope: at which angle they begin to slide, and how fast they then accelerate.
#include <cmath>
#include <numbers>

#include "bench/validation/checks.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Gravity on a slope of this angle that falls towards `direction_rad` of the world's plane.
Vector3d slope_gravity(double angle_rad, double direction_rad) {
  return kG * Vector3d(std::sin(angle_rad) * std::cos(direction_rad), std::sin(angle_rad) * std::sin(direction_rad),
                       -std::cos(angle_rad));
}

/// What a body does on a slope, in the world's plane.
struct Slide {
  Vector2d acceleration_m_s2;  ///< mean from 0.5 s to 1 s
  double speed_m_s;            ///< after 1 s
};

template <class Velocity>
Slide slide(World& world, const Velocity& velocity) {
  hold(world, 0.0, 6.0, 0.5);
  const Vector2d before = velocity();
  hold(world, 0.0, 6.0, 0.5);
  return {(velocity() - before) / 0.5, velocity().norm()};
}

/// A short straight robot, whose axis is x.
Slide slide_robot(double angle_rad, double direction_rad) {
  RobotModel robot = mamba();
  robot.module_count = 6;
  robot.joints.resize(5);
  Scenario scenario;
  scenario.gravity_m_s2 = slope_gravity(angle_rad, direction_rad);
  World world(robot, scenario);
  return slide(world, [&] {
    Vector2d sum = Vector2d::Zero();
    for (std::size_t i = 0; i < 6; ++i) sum += world.module_velocity_m_s(i).head<2>() / 6.0;
    return sum;
  });
}

Slide slide_object(BodyShape shape, double angle_rad, double direction_rad) {
  Scenario scenario = with_object({0.1, 0.1, 0.06}, 0.5);
  scenario.objects[0].shape = shape;
  scenario.gravity_m_s2 = slope_gravity(angle_rad, direction_rad);
  World world(chain(2, JointAxis::kYaw), scenario);
  return slide(world, [&] { return Vector2d(world.object_velocity_m_s(0).head<2>()); });
}

/// Checks the friction angle from both sides and the acceleration beyond it, and adds the curves to the plot.
template <class Experiment>
void check_direction(Section& section, Plot& plot, const std::string& name, double mu, double steepest_rad,
                     const Experiment& experiment) {
  const double angle_rad = std::atan(mu);
  section.cases.push_back({name + ": speed after 1 s at 0.97 of the friction angle (holds)", "m/s", 0.0,
                           experiment(0.97 * angle_rad).speed_m_s, 0.002, false});
  const auto expected = [mu](double slope_rad) {
    return std::max(0.0, kG * (std::sin(slope_rad) - mu * std::cos(slope_rad)));
  };
  const double beyond_rad = 1.03 * angle_rad;
  section.cases.push_back({name + ": acceleration at 1.03 of this angle (slides)", "m/s²", expected(beyond_rad),
                           experiment(beyond_rad).acceleration_m_s2.norm(), 0.05});
  section.cases.push_back({name + fmt::format(": acceleration at {:.0f}°", steepest_rad / kDegree), "m/s²",
                           expected(steepest_rad), experiment(steepest_rad).acceleration_m_s2.norm(), 0.01});
  Series law{name + ": law", {}, {}, Mark::kLine};
  Series found{name + ": simulated", {}, {}, Mark::kDots};
  for (int i = 0; i <= 60; ++i) {
    const double slope_rad = steepest_rad * i / 60.0;
    law.x.push_back(slope_rad / kDegree);
    law.y.push_back(expected(slope_rad));
  }
  for (int i = 0; i <= 8; ++i) {
    const double slope_rad = steepest_rad * i / 8.0;
    found.x.push_back(slope_rad / kDegree);
    found.y.push_back(experiment(slope_rad).acceleration_m_s2.norm());
  }
  plot.series.push_back(law);
  plot.series.push_back(found);
}

}  // namespace

Section check_slopes() {
  Section section{"Slopes",
                  "A body holds on a slope up to the friction angle atan(mu) and accelerates with g (sin a - mu cos a) "
                  "beyond it: objects (the same friction in each direction) and the robot (other friction along its "
                  "axis than across it). The slope is a tilted gravity.",
                  {},
                  {},
                  {}};
  Plot objects{"Objects: mu 0.4 in each direction", "slope [deg]", "acceleration [m/s^2]", {}};
  const double mu = Scenario{}.friction.object_ground;
  for (const auto& [shape, name] : {std::pair{BodyShape::kBox, "box"}, std::pair{BodyShape::kCylinder, "cylinder"}}) {
    // 30° from the edges of the box, so that neither of the two directions in which the engine `ode` bounds the
    // friction is that of the slope.
    check_direction(section, objects, name, mu, 40.0 * kDegree,
                    [shape = shape](double slope_rad) { return slide_object(shape, slope_rad, 120.0 * kDegree); });
  }
  const RobotModel robot = mamba();
  Plot skin{"Robot: mu 0.05 along and 0.5 across", "slope [deg]", "acceleration [m/s^2]", {}};
  check_direction(section, skin, "robot along its axis", robot.friction_along, 32.0 * kDegree,
                  [](double slope_rad) { return slide_robot(slope_rad, 0.0); });
  check_direction(section, skin, "robot across its axis", robot.friction_across, 32.0 * kDegree,
                  [](double slope_rad) { return slide_robot(slope_rad, 90.0 * kDegree); });
  // A slope oblique to the axis: the bound on the friction is a rectangle, so that the robot slides along its axis and
  // holds across it.
  constexpr double kSlope_rad = 20.0 * kDegree;
  const Slide oblique = slide_robot(kSlope_rad, 45.0 * kDegree);
  section.cases.push_back({"robot, slope of 20° at 45° to its axis: acceleration along the axis", "m/s²",
                           kG * (std::sin(kSlope_rad) * std::sqrt(0.5) - robot.friction_along * std::cos(kSlope_rad)),
                           oblique.acceleration_m_s2.x(), 0.02});
  section.cases.push_back({"robot, the same: acceleration across the axis (holds)", "m/s²", 0.0,
                           oblique.acceleration_m_s2.y(), 0.05, false});
  section.figures.push_back({"Acceleration on a slope", "slopes.png", {objects, skin}});
  return section;
}

}  // namespace constrictor::validation
