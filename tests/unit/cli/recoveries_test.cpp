// The causes and times of the planner's recoveries, as an evaluation derives them from reports.
#include "cli/evaluate/recoveries.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "constrictor/constants.hpp"
#include "constrictor/messages.hpp"
#include "planner/mission_state.hpp"

namespace constrictor::cli {
namespace {

using nlohmann::json;
using Causes = std::map<std::string, int>;

struct State {
  double at_s;
  std::string name;
};

struct Event {
  double at_s;
  std::string name;
  std::string detail = {};
  std::string colour = "unknown";
  std::uint64_t source = msg::kAuthorityPlanner;
};

json report(int recoveries, const std::vector<State>& states, const std::vector<Event>& events = {}) {
  json made{{"recoveries", recoveries}, {"states", json::array()}, {"events", json::array()}};
  for (const State& state : states) made["states"].push_back({{"sim_time_s", state.at_s}, {"state", state.name}});
  for (const Event& event : events) {
    made["events"].push_back(
        {{"sim_time_s", event.at_s},
         {"event", event.name},
         {"parameters", {{"goal_id", (event.source << 48) + 5}, {"detail", event.detail}, {"colour", event.colour}}}});
  }
  return made;
}

Causes causes(const json& report, const SearchLimits& limits = {}) {
  return recoveries_of(report, 1000.0, limits).by_cause;
}

TEST(Recoveries, HaveTheStateThatTheyEndedAndTheReasonOfItsGoal) {
  const json lost = report(3,
                           {{0, "search line or object"},
                            {1, "follow line"},
                            {9, "search line or object"},
                            {12, "track object"},
                            {15, "pregrasp"},
                            {20, "search object"},
                            {22, "track object"},
                            {24, "approach anew"}},
                           {{8.98, "line_lost"},
                            {8.98, "goal_aborted", "line lost"},
                            {19.98, "object_pregrasp_lost"},
                            {19.98, "goal_aborted", "the object is 0.25 m away"},
                            {23.98, "object_lost"}});
  EXPECT_EQ(causes(lost), (Causes{{"follow line: line lost", 1},
                                  {"pregrasp: the object is # m away", 1},
                                  {"track object: object lost", 1}}));
}

TEST(Recoveries, WithoutAnEventFollowFromTheChangeOfState) {
  EXPECT_EQ(causes(report(3, {{0, "search line"},
                              {5, "turn back"},
                              {9, "follow line to drop zone"},
                              {50, "search line"},
                              {60, "drop"},
                              {300, "search line"}})),
            (Causes{{"search line: the line leads the wrong way", 1},
                    {"follow line to drop zone: it stood still, or its time limit passed", 1},
                    {"drop: it stood still, or its time limit passed", 1}}));
  EXPECT_EQ(causes(report(1, {{0, "track object"}, {240, "search object"}})),
            (Causes{{"track object: its time limit passed", 1}}));
}

TEST(Recoveries, AnotherObjectAfterADropWasPushedOffItsZone) {
  const auto after_drop = [](const std::string& found) {
    return causes(report(1, {{0, "drop"}, {20, "inspect drop"}, {21, "search object"}, {23, "track object"}},
                         {{19.98, "dropping_done", "", "red"}, {22.98, "object_found", "", found}}));
  };
  EXPECT_EQ(after_drop("green"), (Causes{{"inspect drop: a delivered object was pushed off its zone", 1}}));
  EXPECT_EQ(after_drop("red"), (Causes{{"inspect drop: the dropped object was not seen on its zone", 1}}));
}

// Source: MissionPlanner::after_drop() and after_inspection(), with inspect_s: 20.
TEST(Recoveries, ADroppedObjectWasSeenOutsideItsZoneOrNotSeenOnIt) {
  const SearchLimits limits{30.0, 60.0, 20.0};
  const auto look = [&](double lasts_s, const std::vector<Event>& events = {}) {
    const std::vector<State> states{{0, "drop"}, {20, "inspect drop"}, {20 + lasts_s, "search object"}};
    return causes(report(1, states, events), limits).begin()->first;
  };
  const std::string outside = "the dropped object was seen outside its zone";
  const std::string unseen = "the dropped object was not seen on its zone";
  EXPECT_EQ(look(3), "inspect drop: " + outside);
  EXPECT_EQ(look(20.02), "inspect drop: " + unseen) << "the look has taken its time";
  EXPECT_EQ(look(3, {{22.96, "object_found"}, {22.98, "goal_succeeded"}}), "inspect drop: " + unseen)
      << "the look has found it";
  EXPECT_EQ(look(3, {{22.0, "goal_succeeded"}, {22.02, "goal_running"}}), "inspect drop: " + outside)
      << "during the next look";
  EXPECT_EQ(causes(report(1, {{0, "drop"}, {20, "search object"}}, {{19.98, "dropping_done"}})),
            (Causes{{"drop: " + outside, 1}}));
}

// Source: MissionPlanner::next_by_time(): a search that has taken its time limit begins anew in the same state.
TEST(Recoveries, ASearchBeyondItsTimeLimitStaysInItsState) {
  const json search = report(3, {{0, "search line or object"}, {50, "grasp"}, {70, "search line"}});
  EXPECT_EQ(causes(search, {30.0, 400.0}),
            (Causes{{"search line or object: its time limit passed", 1}, {"search line: its time limit passed", 2}}));
  EXPECT_EQ(causes(search), (Causes{{"other", 3}})) << "the limits are unknown";
}

TEST(Recoveries, RefusalsSuspensionsAndTheUsualCourseAreNone) {
  EXPECT_EQ(causes(report(0, {{0, "drop"}, {5, "search line"}}, {{4.98, "goal_refused", "no zone was seen yet"}})),
            Causes{});
  const json refused = report(1, {{0, "drop"}, {5, "search line"}}, {{4.98, "goal_refused", "no zone was seen yet"}});
  EXPECT_EQ(causes(refused), (Causes{{"other", 1}}));
  const json usual = report(9, {{0, "search line or object"},
                                {1, "follow line"},
                                {5, "search object"},
                                {8, "track object"},
                                {9, "pregrasp"},
                                {15, "grasp"},
                                {25, "search line"},
                                {26, "follow line to drop zone"},
                                {40, "suspended"},
                                {60, "search line"},
                                {61, "drop"},
                                {70, "inspect drop"},
                                {72, "turn round"},
                                {75, "search line or object"},
                                {76, "follow line"},
                                {80, "suspended"},
                                {85, "search line or object"}});
  EXPECT_EQ(causes(usual), (Causes{{"other", 9}}));
}

// The planner counts a search that ends without the object, and then has no object left that it may try.
TEST(Recoveries, TheLastOneMayEndTheMission) {
  const auto failed = [](const std::string& from, const std::string& reason, int counted) {
    json made = report(counted, {{0, "follow line"}, {9, from}, {99, "failed"}});
    made["reason"] = "the planner gave up: " + reason;
    return causes(made);
  };
  const std::string given_up = "not delivered: red (6 attempts failed, the last in search object: not found)";
  EXPECT_EQ(failed("search object", given_up, 1), (Causes{{"search object: its time limit passed", 1}}));
  EXPECT_EQ(failed("inspect drop", given_up, 1),
            (Causes{{"inspect drop: the dropped object was not seen on its zone", 1}}));
  EXPECT_EQ(failed("inspect drop", given_up, 0), Causes{}) << "another object had been put aside before";
  EXPECT_EQ(failed("search object", "the time limit of the mission passed in state search object", 0), Causes{});
  EXPECT_EQ(failed("search object", "the time limit of the mission passed in state search object", 1),
            (Causes{{"other", 1}}));
}

// Another source's goals say nothing about the planner's.
TEST(Recoveries, IgnoreTheGoalsOfOthers) {
  const json both = report(1, {{0, "track object"}, {9, "search object"}},
                           {{8.98, "goal_aborted", "theirs", "unknown", msg::kAuthorityOperator}});
  EXPECT_EQ(causes(both), (Causes{{"track object: its time limit passed", 1}}));
}

// Independent: the planner's own table of states and losses. It fails if a state or an event gets another name.
TEST(Recoveries, KnowEveryLossOfThePlannersTable) {
  int losses = 0;
  for (std::size_t i = 0; i < kMissionStates; ++i) {
    const StateRow& row = row_of(static_cast<MissionState>(i));
    for (const EventTransition& loss : row.losses) {
      if (loss.event == msg::kEventNone) continue;
      ++losses;
      const std::string event{constrictor::name_of(constants::kEvent, loss.event)};
      const Recoveries found = recoveries_of(
          report(1, {{0, row.name}, {9, constrictor::name_of(loss.to)}}, {{8.98, event}}), 12.0, SearchLimits());
      ASSERT_EQ(found.by_cause.size(), 1u) << row.name;
      EXPECT_TRUE(found.by_cause.begin()->first.starts_with(std::string(row.name) + ": ")) << row.name << " " << event;
      EXPECT_EQ(found.longest.duration_s, 3.0) << constrictor::name_of(loss.to) << " is a search";
    }
  }
  EXPECT_GT(losses, 5);
}

TEST(LongestRecovery, LastsFromTheLossUntilTheMissionGoesOn) {
  const json lost = report(3,
                           {{0, "search line or object"},
                            {40, "follow line"},
                            {50, "search line or object"},
                            {53, "follow line"},
                            {60, "track object"},
                            {70, "approach anew"},
                            {76, "search object"},
                            {80, "search line or object"},
                            {84, "track object"},
                            {95, "grasp"}},
                           {{49.98, "line_lost"}, {69.98, "object_lost"}});
  const RecoveryTime longest = recoveries_of(lost, 120.0, {}).longest;
  EXPECT_EQ(longest.begin_s, 70.0);
  EXPECT_EQ(longest.duration_s, 14.0) << "the search at the beginning, of 40 s, is none";
  EXPECT_EQ(longest.cause, "track object: object lost");
}

TEST(LongestRecovery, GoesOnWhileTheLineIsLostAgainAtOnce) {
  const auto duration_s = [](double follows_s) {
    const double again = 10 + follows_s;
    return recoveries_of(report(2, {{0, "follow line to drop zone"},
                                    {5, "search line"},
                                    {10, "follow line to drop zone"},
                                    {again, "search line"},
                                    {again + 7, "follow line to drop zone"}}),
                         100.0, {})
        .longest.duration_s;
  };
  EXPECT_DOUBLE_EQ(duration_s(1.9), 13.9);
  EXPECT_DOUBLE_EQ(duration_s(2.0), 7.0);
}

TEST(LongestRecovery, EndsWithTheMissionOrWithASuspension) {
  const std::vector<State> states{{0, "follow line"}, {5, "search line or object"}, {25, "suspended"}};
  EXPECT_EQ(recoveries_of(report(1, states), 90.0, {}).longest.duration_s, 20.0);
  EXPECT_EQ(recoveries_of(report(1, {states[0], states[1]}), 90.0, {}).longest.duration_s, 85.0);
  EXPECT_TRUE(std::isnan(recoveries_of(report(0, {states[0]}), 90.0, {}).longest.duration_s));
}

TEST(LongestRecovery, OfASearchThatFailsIsTheWholeSearch) {
  const json search = report(1, {{0, "grasp"}, {20, "search line"}});
  const RecoveryTime longest = recoveries_of(search, 900.0, {180, 720}).longest;
  EXPECT_EQ(longest.duration_s, 880.0);
  EXPECT_EQ(longest.cause, "search line: its time limit passed");
}

// Whatever a report contains, the causes add up to the number of recoveries that the planner has counted.
TEST(Recoveries, AddUpToTheReportsNumber) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const std::vector<std::string> names{"goal_aborted", "goal_refused",   "line_lost",     "object_lost",
                                       "end_of_line",  "goal_cancelled", "dropping_done", "object_found"};
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<State> states;
    std::vector<Event> events;
    double at_s = 0;
    for (std::size_t i = 0; i < below(12); ++i) {
      states.push_back({at_s, constrictor::name_of(static_cast<MissionState>(below(kMissionStates)))});
      at_s += static_cast<double>(below(300)) / 10 - 1;
      if (below(2) == 0) events.push_back({at_s - static_cast<double>(below(20)) / 100, names[below(names.size())]});
    }
    const int counted = static_cast<int>(below(15));
    json made = report(counted, states, events);
    if (below(2) == 0) made["reason"] = "the planner gave up: not delivered: red";
    const Recoveries found = recoveries_of(made, at_s, {5, 20});
    int sum = 0;
    for (const auto& [cause, count] : found.by_cause) sum += count;
    ASSERT_EQ(sum, counted) << "seed " << seed << ", trial " << trial << ": " << made;
    ASSERT_FALSE(found.longest.duration_s < 0);
  }
}

}  // namespace
}  // namespace constrictor::cli
