// One concrete scene, after the seed has chosen every variation. The simulated world is built from it. World frame W:
// z up, ground at z = 0. SI units.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario_loader/line_path.hpp"

namespace constrictor {

/// Of a scenario without a line, which may have a mission: blue. This header does without the messages, because the
/// engine includes it; scenario_draft.cpp compares the number with msg::kColourBlue.
inline constexpr std::uint8_t kUsualLineColour = 3;

/// msg::kShape…; sim/physics/scene_description.cpp compares the numbers.
enum class BodyShape : std::uint8_t { kCylinder = 0, kBox = 1 };

/// An object that the robot can grasp. It starts upright on the ground.
struct ScenarioObject {
  std::uint8_t colour = 0;  ///< msg::kColour…
  BodyShape shape = BodyShape::kCylinder;
  Eigen::Vector3d size_m{0.085, 0.085, 0.15};  ///< cylinder: radius, radius, height; box: extents
  double mass_kg = 0.4;
  Eigen::Vector2d position_m{0.0, 0.0};
  double yaw_rad = 0.0;

  /// [m] radius of the smallest circle about the object's vertical axis that contains its footprint.
  [[nodiscard]] double footprint_radius_m() const {
    return shape == BodyShape::kCylinder ? size_m.x() : 0.5 * size_m.head<2>().norm();
  }
};

/// A coloured disc on the ground.
struct ScenarioZone {
  std::uint8_t colour = 0;
  Eigen::Vector2d position_m{0.0, 0.0};
  double radius_m = 0.2;
};

/// A wall (box) or peg (upright cylinder) that stands on the ground and never moves.
struct ScenarioObstacle {
  BodyShape shape = BodyShape::kBox;
  Eigen::Vector3d size_m{0.1, 0.1, 0.1};
  Eigen::Vector2d position_m{0.0, 0.0};
  double yaw_rad = 0.0;
};

/// A scripted force on an object, for example to pull it out of a grasp. It begins at `at_s`, or once the object is
/// `displaced_m` away from its start; the unused one of these two fields is NaN. The force lasts `duration_s`. Or the
/// object is moved at once, as if a person carried it away.
struct ScenarioPerturbation {
  std::size_t object = 0;
  double at_s = 0.0;
  double displaced_m = 0.0;
  double duration_s = 0.0;
  Eigen::Vector3d force_n{0.0, 0.0, 0.0};  ///< in W, at the object's centre
  Eigen::Vector2d moved_m{0.0, 0.0};       ///< in W: by which the object is carried away; zero: it is not
};

/// Coulomb friction coefficients. The robot file has those of the robot's skin on the ground; `ground_scale` scales
/// them.
struct ScenarioFriction {
  double ground_scale = 1.0;  ///< factor on the robot file's coefficients for skin on ground
  double object_robot = 0.5;
  double object_ground = 0.4;  ///< also for contacts of objects with objects and obstacles
  double robot_robot = 0.2;
};

/// How the robot's body differs from its robot file. No component knows it.
struct ScenarioBody {
  double mass_scale = 1.0;  ///< factor on the robot file's mass of a module
};

struct ScenarioLight {
  Eigen::Vector3d direction{0.3, -0.4, 0.85};  ///< unit vector from the scene to the light
  double intensity = 1.0;
  double ambient = 0.35;
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 0;
  PlanarPose line_begin;                   ///< where the line begins
  std::vector<LineSegment> line_segments;  ///< of which the line is made, from the zones to the objects; empty: no line
  std::vector<Eigen::Vector2d> line_m;     ///< its points
  double line_width_m = 0.05;
  std::uint8_t line_colour = kUsualLineColour;  ///< msg::kColour…
  std::vector<ScenarioObject> objects;
  std::vector<ScenarioZone> zones;
  std::vector<ScenarioObstacle> obstacles;
  std::vector<ScenarioPerturbation> perturbations;
  ScenarioFriction friction;
  ScenarioBody body;
  ScenarioLight light;
  Eigen::Vector3d ground_colour{0.5, 0.5, 0.5};  ///< linear RGB
  double ground_gloss = 0.0;                     ///< strength of the light's reflection in the ground; 0: matt
  Eigen::Vector2d start_m{0.0, 0.0};             ///< centre of the head; the body lies straight behind it
  double start_yaw_rad = 0.0;
  double start_height_m = 0.0;  ///< [m] height of the body above the ground; only tests set it
  /// In W, whose ground is z = 0: a tilted gravity makes the ground a slope.
  Eigen::Vector3d gravity_m_s2{0.0, 0.0, -9.81};
  bool sensor_noise = true;      ///< false: the noise in the robot file is ignored
  double camera_noise_sd = 0.0;  ///< standard deviation of pixel values on a scale from 0 to 1
};

}  // namespace constrictor
