#include "sim/scenario_loader/scenario_writer.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <numbers>

#include "constrictor/constants.hpp"
#include "sim/scenario_loader/scenario_file.hpp"

namespace constrictor {
namespace {

using YAML::Emitter;

/// The emitter's own format has either too few digits or, for 0.1, 0.10000000000000001. The sum makes 0 of -0.
std::string digits(double value) { return fmt::format("{}", value + 0.0); }

void put(Emitter& out, const char* key, double value) { out << YAML::Key << key << YAML::Value << digits(value); }

template <int kSize>
void put(Emitter& out, const char* key, const Eigen::Matrix<double, kSize, 1>& vector) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double value : vector) out << digits(value);
  out << YAML::EndSeq;
}

void put_colour(Emitter& out, std::uint8_t colour) {
  out << YAML::Key << "colour" << YAML::Value << name_of(constants::kColour, colour);
}

/// A file accepts angles up to one turn.
void put_angle(Emitter& out, const char* key, double angle_rad) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  put(out, key, std::abs(angle_rad) <= kTurn_rad ? angle_rad : std::remainder(angle_rad, kTurn_rad));
}

void put_shape(Emitter& out, BodyShape shape, const Eigen::Vector3d& size_m) {
  const bool box = shape == BodyShape::kBox;
  out << YAML::Key << "shape" << YAML::Value << (box ? "box" : "cylinder");
  if (box) return put(out, "size_m", size_m);
  put(out, "radius_m", size_m.x());
  put(out, "height_m", size_m.z());
}

/// Writes a list of maps below a key; nothing if it is empty. `style` is that of each map.
template <class Items, class Write>
void put_list(Emitter& out, const char* key, const Items& items, YAML::EMITTER_MANIP style, Write write) {
  if (items.empty()) return;
  out << YAML::Newline << YAML::Newline << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (const auto& item : items) {
    out << style << YAML::BeginMap;
    write(item);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

/// Writes a section on one line.
template <class Write>
void put_section(Emitter& out, const char* key, Write write) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
  write();
  out << YAML::EndMap;
}

void put_line(Emitter& out, const Scenario& scene) {
  if (scene.line_segments.empty()) return;
  out << YAML::Newline << YAML::Newline << YAML::Key << "line" << YAML::Value << YAML::BeginMap;
  put_colour(out, scene.line_colour);
  put(out, "width_m", scene.line_width_m);
  put(out, "begin_m", scene.line_begin.p);
  put_angle(out, "begin_yaw_rad", scene.line_begin.yaw_rad);
  out << YAML::Key << "segments" << YAML::Value << YAML::BeginSeq;
  for (const LineSegment& segment : scene.line_segments) {
    out << YAML::Flow << YAML::BeginMap;
    put(out, "length_m", segment.length_m);
    put(out, "curvature_1_m", segment.curvature_1_m);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
}

void put_bodies(Emitter& out, const Scenario& scene) {
  put_list(out, "objects", scene.objects, YAML::Block, [&](const ScenarioObject& object) {
    put_colour(out, object.colour);
    put(out, "position_m", object.position_m);
    put_angle(out, "yaw_rad", object.yaw_rad);
    put_shape(out, object.shape, object.size_m);
    put(out, "mass_kg", object.mass_kg);
  });
  put_list(out, "zones", scene.zones, YAML::Flow, [&](const ScenarioZone& zone) {
    put_colour(out, zone.colour);
    put(out, "position_m", zone.position_m);
    put(out, "radius_m", zone.radius_m);
  });
  put_list(out, "obstacles", scene.obstacles, YAML::Block, [&](const ScenarioObstacle& obstacle) {
    put(out, "position_m", obstacle.position_m);
    put_angle(out, "yaw_rad", obstacle.yaw_rad);
    put_shape(out, obstacle.shape, obstacle.size_m);
  });
  put_list(out, "perturbations", scene.perturbations, YAML::Flow, [&](const ScenarioPerturbation& perturbation) {
    out << YAML::Key << "object" << YAML::Value << perturbation.object;
    if (std::isnan(perturbation.at_s)) put(out, "when_displaced_m", perturbation.displaced_m);
    else put(out, "at_s", perturbation.at_s);
    if (!perturbation.moved_m.isZero(0.0)) return put(out, "moved_m", perturbation.moved_m);
    put(out, "duration_s", perturbation.duration_s);
    put(out, "force_n", perturbation.force_n);
  });
}

void put_surroundings(Emitter& out, const Scenario& scene) {
  put_section(out, "friction", [&] {
    put(out, "ground_scale", scene.friction.ground_scale);
    put(out, "object_robot", scene.friction.object_robot);
    put(out, "object_ground", scene.friction.object_ground);
    put(out, "robot_robot", scene.friction.robot_robot);
  });
  put_section(out, "body", [&] { put(out, "mass_scale", scene.body.mass_scale); });
  put_section(out, "light", [&] {
    put(out, "direction", scene.light.direction);
    put(out, "intensity", scene.light.intensity);
    put(out, "ambient", scene.light.ambient);
  });
  const Eigen::Vector2d downhill = scene.gravity_m_s2.head<2>();
  if (!downhill.isZero(0.0)) {
    put_section(out, "slope", [&] {
      put(out, "grade", downhill.norm() / -scene.gravity_m_s2.z());
      put(out, "uphill_rad", std::atan2(-downhill.y(), -downhill.x()));
    });
  }
  put(out, "ground_colour", scene.ground_colour);
  put(out, "ground_gloss", scene.ground_gloss);
  put_section(out, "noise", [&] {
    out << YAML::Key << "sensors" << YAML::Value << scene.sensor_noise;
    put(out, "camera_sd", scene.camera_noise_sd);
  });
}

}  // namespace

std::string scenario_text(const Scenario& scene, const std::string& mission, const std::string& comment) {
  Emitter out;
  out << YAML::Comment(comment) << YAML::BeginMap << YAML::Key << "name" << YAML::Value << scene.name;
  if (!mission.empty())
    out << YAML::Newline << YAML::Newline << YAML::Key << "mission" << YAML::Value << YAML::Load(mission);
  put_line(out, scene);
  put_bodies(out, scene);
  out << YAML::Newline << YAML::Newline;
  put_section(out, "start", [&] {
    put(out, "position_m", scene.start_m);
    put_angle(out, "yaw_rad", scene.start_yaw_rad);
  });
  out << YAML::Newline << YAML::Newline;
  put_surroundings(out, scene);
  out << YAML::EndMap << YAML::Newline;
  std::string text = out.c_str();
  static_cast<void>(read_scenario(Configuration::parse(text, "the drawn scene"), scene.seed));
  return text;
}

}  // namespace constrictor
