// The limits at which the report or the plant ends a run.
#include "report_of.hpp"

namespace constrictor {
namespace {

using testing::Outcome;
using testing::report_of;
using testing::Story;

constexpr const char* kNineSeconds =
    "max_sim_time_s: 9.0\nsettle_s: 2.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n";

TEST(Report, EndsAtTheTimeLimit) {
  Story story;
  story.mission_end_tick = 1'000'000;
  const Outcome outcome = report_of(story, {}, kNineSeconds);
  EXPECT_EQ(outcome.mission["ticks"], 450);
  EXPECT_EQ(outcome.mission["success"], false);
  EXPECT_EQ(outcome.mission["mission"], "unfinished");
  EXPECT_EQ(outcome.mission["reason"], "time limit of 9 s (max_sim_time_s of report)");
  EXPECT_TRUE(outcome.files.contains("run/snapshots/0000450_camera.png")) << "the figure shows the end of the run";
}

// A mission with a limit of 1500 s was ended at the report's 900 s.
TEST(Report, GoesOnUntilTheLimitThatTheScenarioStates) {
  const std::string mission = "{sequence: [green, red], line_colour: blue, time_limits: {mission_s: 12}}";
  Story story;
  story.mission_end_tick = 601;  // the planner's limit has passed
  story.mission_end = msg::kMissionFailed;
  EXPECT_EQ(report_of(story, {}, kNineSeconds, {}, mission).mission["reason"],
            "the planner gave up: more than 60 recoveries");
  story.mission_end_tick = 1'000'000;  // the planner is suspended
  const Outcome outcome = report_of(story, {}, kNineSeconds, {}, mission);
  EXPECT_EQ(outcome.mission["ticks"], 750);
  EXPECT_EQ(outcome.mission["reason"], "time limit of 15 s (mission_s of the scenario, with the time to settle)");
  EXPECT_EQ(report_of(story, {}, kNineSeconds, {.end_tick = 300, .plant_limit_s = 6.02}, mission).mission["reason"],
            "time limit of 6.02 s (--max-sim-time)");
}

TEST(Report, AShorterLimitOfTheScenarioDoesNotShortenTheRun) {
  Story story;
  story.mission_end_tick = 1'000'000;
  const Outcome outcome = report_of(story, {}, kNineSeconds, {},
                                    "{sequence: [green, red], line_colour: blue, time_limits: {mission_s: 3}}");
  EXPECT_EQ(outcome.mission["ticks"], 450);
}

TEST(Report, NamesThePlantsTimeLimit) {
  const Outcome outcome = report_of({}, {}, {}, {.end_tick = 300, .plant_limit_s = 6.02});
  EXPECT_EQ(outcome.mission["reason"], "time limit of 6.02 s (--max-sim-time)");
}

}  // namespace
}  // namespace constrictor
