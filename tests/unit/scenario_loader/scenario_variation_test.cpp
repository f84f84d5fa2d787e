#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

TEST(ScenarioVariation, EqualSeedsGiveEqualScenes) {
  const Scenario a = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 7);
  const Scenario b = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 7);
  EXPECT_EQ(a.line_m, b.line_m);
  EXPECT_EQ(a.objects[0].position_m, b.objects[0].position_m);
  EXPECT_EQ(a.objects[1].mass_kg, b.objects[1].mass_kg);
  EXPECT_EQ(a.light.direction, b.light.direction);
  EXPECT_EQ(a.start_yaw_rad, b.start_yaw_rad);
}

/// [1/m] the greatest curvature to the left and to the right of a polyline, by circles through three consecutive
/// points.
std::pair<double, double> sharpest_bends(const std::vector<Eigen::Vector2d>& line) {
  std::pair<double, double> bends{0.0, 0.0};
  for (std::size_t i = 2; i < line.size(); ++i) {
    const Eigen::Vector2d a = line[i - 1] - line[i - 2];
    const Eigen::Vector2d b = line[i] - line[i - 1];
    const double curvature = 2 * (a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm() * (a + b).norm());
    bends.first = std::max(bends.first, curvature);
    bends.second = std::min(bends.second, curvature);
  }
  return bends;
}

/// The values of one number of the scene for many seeds, and the range of case_study.yaml.
struct Aspect {
  double least = 0.0, most = 0.0;
  std::set<long long> millionths;
};

class Aspects {
 public:
  void note(const std::string& name, double value, double least, double most) {
    Aspect& aspect = aspects_.try_emplace(name, Aspect{least, most, {}}).first->second;
    EXPECT_GE(value, least - 1e-9) << name;
    EXPECT_LE(value, most + 1e-9) << name;
    aspect.millionths.insert(std::llround(value * 1e6));
  }
  /// `value` must deviate from `nominal` by at most `by`.
  void around(const std::string& name, double value, double nominal, double by) {
    note(name, value, nominal - by, nominal + by);
  }

  /// At least half of the seeds gave a different value, and the values cover at least half of the range.
  void vary(std::size_t seeds) const {
    for (const auto& [name, aspect] : aspects_) {
      EXPECT_GT(aspect.millionths.size(), seeds / 2) << name;
      EXPECT_GT(1e-6 * static_cast<double>(*aspect.millionths.rbegin() - *aspect.millionths.begin()),
                0.5 * (aspect.most - aspect.least))
          << name;
    }
  }

 private:
  std::map<std::string, Aspect> aspects_;
};

// The ranges are those of `variation` in wide.yaml.
TEST(ScenarioVariation, HeightAndRadiusVaryIndependently) {
  Aspects aspects;
  double product = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Scenario scene = load_scenario(testing::source_path("sim/scenarios/wide.yaml"), seed);
    for (const ScenarioObject& object : scene.objects) {
      aspects.around("radius", object.size_m.x(), 0.084, 0.0345);
      aspects.around("height", object.size_m.z(), 0.18, 0.1201);
      product += (object.size_m.x() - 0.084) / 0.0345 * (object.size_m.z() - 0.18) / 0.1201;
    }
  }
  // The mean product of two independent uniform values in -1 to 1 has the standard deviation 1 / (3 sqrt(n)).
  EXPECT_LT(std::abs(product / (2 * kSeeds)), 4.0 / (3.0 * std::sqrt(2.0 * kSeeds)));
}

// The ranges are those of `variation` in case_study.yaml.
TEST(ScenarioVariation, TheSeedVariesEveryAspectWithinItsRange) {
  constexpr std::size_t kSeeds = 100;
  std::set<int> object_sides;
  std::set<int> zone_sides;
  std::set<int> line_sides;
  Aspects aspects;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), seed);
    double length_m = 0.0;
    for (std::size_t i = 1; i < scene.line_m.size(); ++i) length_m += (scene.line_m[i] - scene.line_m[i - 1]).norm();
    aspects.around("line length", length_m, 4.5, 0.45);
    const auto [left_1_m, right_1_m] = sharpest_bends(scene.line_m);
    aspects.around("bend to the left", left_1_m, 0.8, 0.16);
    aspects.around("bend to the right", right_1_m, -0.8, 0.16);
    line_sides.insert(scene.line_m[80].y() > 0 ? 1 : 0);

    // Objects in the frame of the line's end, which is straight.
    const Eigen::Vector2d end = scene.line_m.back();
    const Eigen::Vector2d ahead = (end - *(scene.line_m.end() - 3)).normalized();
    int sides = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string which = i == 0 ? "green object " : "red object ";
      const ScenarioObject& object = scene.objects[i];
      const Eigen::Vector2d d = object.position_m - end;
      const double left_m = ahead.x() * d.y() - ahead.y() * d.x();
      sides = 2 * sides + (left_m > 0 ? 1 : 0);
      aspects.around(which + "ahead", ahead.dot(d), i == 0 ? 0.45 : 1.65, 0.05);
      aspects.around(which + "beside", std::abs(left_m), 0.20, 0.05);
      aspects.around(which + "radius", object.size_m.x(), 0.085, 0.0085);
      aspects.around(which + "mass", object.mass_kg, 0.4, 0.16);
      EXPECT_EQ(object.size_m.y(), object.size_m.x());
      EXPECT_EQ(object.size_m.z(), 0.15) << "perception knows the height";
    }
    object_sides.insert(sides);

    // The line begins at (0.3, 0) along x.
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string which = i == 0 ? "green zone " : "red zone ";
      aspects.around(which + "x", scene.zones[i].position_m.x(), 0.3 - 1.25, 0.05);
      aspects.around(which + "beside", std::abs(scene.zones[i].position_m.y()), 0.5, 0.05);
    }
    zone_sides.insert(scene.zones[0].position_m.y() > scene.zones[1].position_m.y() ? 1 : 0);
    aspects.around("start x", scene.start_m.x(), 0.0, 0.04);
    aspects.around("start y", scene.start_m.y(), 0.0, 0.04);
    aspects.around("start yaw", scene.start_yaw_rad, 0.0, 0.1);

    const ScenarioFriction& friction = scene.friction;
    aspects.around("friction of the ground", friction.ground_scale, 1.0, 0.2);
    aspects.around("friction of object and robot", friction.object_robot, 0.5, 0.1);
    aspects.around("friction of object and ground", friction.object_ground, 0.4, 0.08);
    aspects.around("friction of robot and robot", friction.robot_robot, 0.2, 0.04);

    // Tilted by 0.25 rad about x at the most, which moves the azimuth by -0.18 to 0.40 rad, and turned by 0.75 rad
    // about the vertical.
    const Eigen::Vector3d nominal(0.3, -0.4, 0.85);
    const Eigen::Vector3d& light = scene.light.direction;
    EXPECT_NEAR(light.norm(), 1.0, 1e-12);
    const double tilt_rad = std::acos(light.z()) - std::acos(nominal.normalized().z());
    aspects.around("height of the light", tilt_rad, 0.0, 0.25);
    const double turn_rad = std::atan2(light.y(), light.x()) - std::atan2(nominal.y(), nominal.x());
    aspects.note("azimuth of the light", std::remainder(turn_rad, 2 * M_PI), -0.93, 1.15);
    aspects.around("intensity of the light", scene.light.intensity, 1.0, 0.2);
    aspects.around("ambient light", scene.light.ambient, 0.35, 0.07);
    aspects.around("camera noise", scene.camera_noise_sd, 0.01, 0.005);
  }
  aspects.vary(kSeeds);
  EXPECT_EQ(object_sides.size(), 4U);
  EXPECT_EQ(zone_sides.size(), 2U);
  EXPECT_EQ(line_sides.size(), 2U);
}

TEST(ScenarioVariation, RedrawsAVariationThatOverlaps) {
  // Half of all draws put the object on the robot's body. Nevertheless every seed gives a scene without overlaps.
  const std::string text =
      "name: x\nstart: {position_m: [0, 0]}\n"
      "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [-1, 0.2]}\n"
      "variation: {object_position_m: 0.2}\n";
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    EXPECT_GT(std::abs(read_scenario(Configuration::parse(text, "x.yaml"), seed).objects[0].position_m.y()), 0.159);
  }
}

}  // namespace
}  // namespace constrictor
