// What a scenario states about its mission, and how a configuration takes over what is known beforehand.
#include "component/mission.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "component/component.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

TEST(Mission, IsReadFromTheTextOfTheLauncher) {
  const auto mission = parse_mission(
      "{sequence: [red, yellow], line_colour: green, known: {object_height_m: 0.06, object_radius_m: 0.05, "
      "object_max_radius_m: 0.1, zone_radius_m: 0.25, line_width_m: 0.04, zones_at: anywhere}, "
      "time_limits: {mission_s: 600, search_s: 60, follow_s: 50, find_s: 70, task_s: 90, drop_s: 40}}");
  ASSERT_TRUE(mission);
  EXPECT_EQ(mission->sequence, (std::vector<std::uint8_t>{msg::kColourRed, msg::kColourYellow}));
  EXPECT_EQ(mission->line_colour, msg::kColourGreen);
  EXPECT_EQ(mission->known.object_height_m, 0.06);
  EXPECT_EQ(mission->known.object_radius_m, 0.05);
  EXPECT_EQ(mission->known.object_max_radius_m, 0.1);
  EXPECT_EQ(mission->known.zone_radius_m, 0.25);
  EXPECT_EQ(mission->known.line_width_m, 0.04);
  EXPECT_EQ(mission->known.zones_at, kZonesAnywhere);
  EXPECT_EQ(mission->limits.mission_s, 600.0);
  EXPECT_EQ(mission->limits.search_s, 60.0);
  EXPECT_EQ(mission->limits.follow_s, 50.0);
  EXPECT_EQ(mission->limits.find_s, 70.0);
  EXPECT_EQ(mission->limits.task_s, 90.0);
  EXPECT_EQ(mission->limits.drop_s, 40.0);
  EXPECT_FALSE(parse_mission(""));
}

TEST(Mission, MayKnowNothing) {
  for (const char* text :
       {"", "{sequence: [], line_colour: blue}", "{sequence: [red], line_colour: blue, known: {}}"}) {
    const PriorKnowledge known = prior_knowledge(text);
    EXPECT_FALSE(known.object_height_m || known.object_radius_m || known.object_max_radius_m || known.zone_radius_m ||
                 known.line_width_m || known.zones_at)
        << text;
  }
}

TEST(Mission, RefusesWhatCannotBe) {
  for (const auto& [text, message] :
       {std::pair{"{sequence: [pink], line_colour: blue}", "--mission:1: sequence"},
        {"{sequence: [red]}", "line_colour"},
        {"{sequence: [blue], line_colour: blue}",
         "line_colour: found the colour of an object, accepted another colour"},
        {"{sequence: [red], line_colour: blue, speed: 3}", "speed"},
        {"{sequence: [red], line_colour: blue, known: {weight_kg: 3}}", "known.weight_kg"},
        {"{sequence: [red], line_colour: blue, known: {zone_radius_m: 0}}", "known.zone_radius_m: found 0"},
        {"{sequence: [red], line_colour: blue, known: {object_radius_m: 0.1, object_max_radius_m: 0.05}}",
         "known.object_radius_m: found 0.1, more than object_max_radius_m: 0.05, accepted"},
        {"{sequence: [red], line_colour: blue, known: {object_height_m: .nan}}", "known.object_height_m: found "},
        {"{sequence: [red], line_colour: blue, known: {zones_at: end}}",
         "known.zones_at: found end, accepted one of beginning, anywhere"},
        {"{sequence: [red], line_colour: blue, time_limits: {drop_s: 0}}", "time_limits.drop_s: found 0"},
        {"{sequence: [red], line_colour: blue, time_limits: {grasp_s: 9}}", "time_limits.grasp_s"},
        {"{sequence: [red], line_colour: blue, known: 3}", "known"}}) {
    try {
      static_cast<void>(parse_mission(text));
      ADD_FAILURE() << text;
    } catch (const ConfigurationError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

struct Knowing : ParameterSet {
  double zone_m = add(zone_m, "zone_m", 0.3, "m", {0.0, 5.0}, kAtStart, "Radius of a zone");
  double depth_m = add(depth_m, "depth_m", 1.0, "m", {0.0, 5.0}, kAtStart, "Nothing that a mission states");
  void know(const PriorKnowledge& known) { zone_m = known.zone_radius_m.value_or(zone_m); }
};

struct Unknowing : ParameterSet {
  double zone_m = add(zone_m, "zone_m", 0.3, "m", {0.0, 5.0}, kAtStart, "Radius of a zone");
};

TEST(Mission, TakesPrecedenceOverTheFileOfAConfigurationThatKnowsTheQuantity) {
  const testing::TemporaryFolder folder;
  constrictor::Setup setup;
  setup.config_file = folder.path() / "config.yaml";
  std::ofstream(setup.config_file) << "zone_m: 0.4\n";
  EXPECT_EQ(load_configuration<Knowing>(setup).zone_m, 0.4);
  setup.mission = "{sequence: [red], line_colour: blue, known: {zone_radius_m: 0.25}}";
  EXPECT_EQ(load_configuration<Knowing>(setup).zone_m, 0.25);
  EXPECT_EQ(load_configuration<Knowing>(setup).depth_m, 1.0);
  EXPECT_EQ(load_configuration<Unknowing>(setup).zone_m, 0.4);
}

}  // namespace
}  // namespace constrictor
