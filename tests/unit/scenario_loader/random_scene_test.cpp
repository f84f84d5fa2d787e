// The scenes of `random_easy`, `random_middle` and `random_hard`, measured from outside for many seeds.
#include "sim/scenario_loader/random_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using Eigen::Vector2d;

constexpr std::uint64_t kSeeds = 150;

/// What a shipped file promises.
struct Promise {
  std::size_t mission_objects;
  double smallest_m, largest_m;  ///< radius of objects
  double sharpest_m;             ///< radius of a bend
  double shortest_m, longest_m;  ///< line
  double zone_min_m, zone_max_m;
  std::size_t pegs, strangers;
};

const std::map<std::string, Promise>& promises() {
  static const std::map<std::string, Promise> all{{"random_easy", {1, 0.075, 0.095, 1.5, 2.0, 3.0, 0.4, 0.45, 0, 0}},
                                                  {"random_middle", {2, 0.065, 0.1, 1.0, 2.5, 5.0, 0.35, 0.4, 3, 0}},
                                                  {"random_hard", {2, 0.05, 0.115, 0.8, 3.0, 8.0, 0.25, 0.3, 5, 2}}};
  return all;
}

Scenario load(const std::string& name, std::uint64_t seed) {
  return load_scenario(testing::source_path("sim/scenarios/" + name + ".yaml"), seed);
}

double length_m(const std::vector<Vector2d>& line_m) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line_m.size(); ++i) sum += (line_m[i] - line_m[i - 1]).norm();
  return sum;
}

double distance_m(const std::vector<Vector2d>& line_m, const Vector2d& at) {
  double least = INFINITY;
  for (const Vector2d& point : line_m) least = std::min(least, (point - at).norm());
  return least;
}

/// Radius of the circle through three points; infinite if they are on a straight line.
double radius_m(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double area = 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  return area < 1e-9 ? INFINITY : (a - b).norm() * (b - c).norm() * (c - a).norm() / (4.0 * area);
}

class RandomScenes : public ::testing::TestWithParam<std::string> {
 protected:
  const Promise& promise() const { return promises().at(GetParam()); }
};

TEST_P(RandomScenes, HaveWhatTheFileNames) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = load(GetParam(), seed);
    ASSERT_EQ(scene.objects.size(), promise().mission_objects + promise().strangers);
    ASSERT_EQ(scene.zones.size(), promise().mission_objects);
    ASSERT_EQ(scene.obstacles.size(), promise().pegs);
    for (const ScenarioObject& object : scene.objects) {
      EXPECT_GE(object.footprint_radius_m(), promise().smallest_m - 1e-9);
      EXPECT_LE(object.footprint_radius_m(), promise().largest_m + 1e-9);
      EXPECT_NE(object.colour, scene.line_colour);
    }
    std::set<std::uint8_t> zone_colours;
    for (const ScenarioZone& zone : scene.zones) {
      EXPECT_GE(zone.radius_m, promise().zone_min_m);
      EXPECT_LE(zone.radius_m, promise().zone_max_m);
      zone_colours.insert(zone.colour);
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      EXPECT_EQ(zone_colours.count(scene.objects[i].colour), i < promise().mission_objects ? 1u : 0u);
    EXPECT_GE(length_m(scene.line_m), promise().shortest_m - 0.01);
    EXPECT_LE(length_m(scene.line_m), promise().longest_m + 0.01);
    for (std::size_t i = 2; i < scene.line_m.size(); ++i)
      EXPECT_GE(radius_m(scene.line_m[i - 2], scene.line_m[i - 1], scene.line_m[i]), 0.98 * promise().sharpest_m);
  }
}

TEST_P(RandomScenes, LeaveTheRobotItsWay) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = load(GetParam(), seed);
    std::vector<Vector2d> others;
    for (std::size_t i = promise().mission_objects; i < scene.objects.size(); ++i)
      others.push_back(scene.objects[i].position_m);
    for (const ScenarioObstacle& peg : scene.obstacles) others.push_back(peg.position_m);
    for (const Vector2d& other : others) {
      EXPECT_GE(distance_m(scene.line_m, other), 0.7);
      for (std::size_t i = 0; i < promise().mission_objects; ++i)
        EXPECT_GE((scene.objects[i].position_m - other).norm(), 0.95);
      for (const ScenarioZone& zone : scene.zones) EXPECT_GE((zone.position_m - other).norm() - zone.radius_m, 0.95);
    }
    for (std::size_t i = 0; i < promise().mission_objects; ++i) {
      const Vector2d at = scene.objects[i].position_m;
      EXPECT_GE(distance_m(scene.line_m, at), 0.3) << "an object stands on the line";
      EXPECT_LE((scene.line_m.back() - at).norm(), 0.8 + 1.4 * static_cast<double>(i)) << "too far to be found";
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((scene.objects[j].position_m - at).norm(), 0.95);
      for (const ScenarioZone& zone : scene.zones)
        EXPECT_GE((zone.position_m - at).norm() - zone.radius_m, 1.0) << "an object stands on a zone";
    }
    for (std::size_t i = 0; i < scene.zones.size(); ++i) {
      EXPECT_GE(std::abs(scene.zones[i].position_m.y()), scene.zones[i].radius_m) << "a zone reaches below the robot";
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE((scene.zones[i].position_m - scene.zones[j].position_m).norm(),
                  scene.zones[i].radius_m + scene.zones[j].radius_m);
    }
  }
}

TEST_P(RandomScenes, FollowFromTheSeed) {
  std::set<double> lengths;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario scene = load(GetParam(), seed);
    const Scenario again = load(GetParam(), seed);
    EXPECT_EQ(scene.line_m, again.line_m);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      EXPECT_EQ(scene.objects[i].position_m, again.objects[i].position_m);
      EXPECT_EQ(scene.objects[i].size_m, again.objects[i].size_m);
    }
    EXPECT_EQ(scene.friction.ground_scale, again.friction.ground_scale);
    lengths.insert(length_m(scene.line_m));
  }
  EXPECT_EQ(lengths.size(), 20u) << "two seeds have the same line";
}

INSTANTIATE_TEST_SUITE_P(Shipped, RandomScenes, ::testing::Values("random_easy", "random_middle", "random_hard"),
                         [](const auto& file) { return file.param; });

const std::string kFile = "name: x\nmission: {sequence: [green, red], line_colour: blue}\n";

std::string refusal_of(const std::string& more, const std::string& file = kFile) {
  try {
    (void)read_scenario(Configuration::parse(file + more, "x.yaml"), 1);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return {};
}

TEST(RandomScene, TheRangesHaveDefaults) { EXPECT_EQ(refusal_of("random: {}\n"), ""); }

TEST(RandomScene, RefusesWhatCannotBe) {
  EXPECT_EQ(refusal_of("random: {line_length_m: [4, 3]}\n"),
            "x.yaml:3: random.line_length_m: found [4, 3], accepted the smaller number first");
  EXPECT_NE(refusal_of("random: {pegs: 17}\n").find("random.pegs: found 17"), std::string::npos);
  EXPECT_NE(refusal_of("random: {trees: 3}\n").find("found an unknown key"), std::string::npos);
  EXPECT_EQ(refusal_of("random: {}\nobjects: []\n"),
            "x.yaml:4: objects: found a section that the random scene replaces, accepted either this section or "
            "`random`");
  EXPECT_NE(refusal_of("random: {}\n", "name: x\nmission: {sequence: [green, red, yellow], line_colour: blue}\n")
                .find("mission.sequence: found 3 colours, 3 of them different"),
            std::string::npos);
  EXPECT_NE(refusal_of("random: {}\n", "name: x\nmission: {sequence: [blue], line_colour: blue}\n")
                .find("mission.line_colour: found the colour of an object"),
            std::string::npos);
  EXPECT_NE(refusal_of("random: {}\n", "name: x\n").find("mission"), std::string::npos);
}

TEST(RandomScene, SaysWhenThereIsNoRoom) {
  // A bend of half a turn brings every line back to itself.
  EXPECT_NE(refusal_of("random: {line_length_m: [9, 9], bend_radius_m: [0.5, 0.5], bend_rad: [3, 3]}\n")
                .find("random: found no scene for seed 1 in which the mission is possible"),
            std::string::npos);
}

// Strangers and pegs of this size often overlap in a draw; then there is another draw.
TEST(RandomScene, BodiesThatOverlapAreDrawnAgain) {
  const std::string file = kFile + "random: {object_radius_m: [0.2, 0.2], pegs: 6, strangers: 3}\n";
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario scene = read_scenario(Configuration::parse(file, "x.yaml"), seed);
    ASSERT_EQ(scene.objects.size(), 5u);
    ASSERT_EQ(scene.obstacles.size(), 6u);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE((scene.objects[i].position_m - scene.objects[j].position_m).norm(), 0.4);
      for (const ScenarioObstacle& peg : scene.obstacles)
        EXPECT_GE((scene.objects[i].position_m - peg.position_m).norm(), 0.24);
    }
  }
}

TEST(RandomScene, TwoObjectsOfOneColourShareAZone) {
  const std::string file = "name: x\nmission: {sequence: [green, green], line_colour: blue}\nrandom: {}\n";
  const Scenario scene = read_scenario(Configuration::parse(file, "x.yaml"), 1);
  EXPECT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.zones.size(), 1u);
}

}  // namespace
}  // namespace constrictor
