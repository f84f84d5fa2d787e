// When a list of parameters shows a change of one of them.
#include <gtest/gtest.h>

#include "client/parameters.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

constexpr const char* kName = "navigation.travel.speed_m_s";

/// A list with one parameter that was changed at this tick and waits for another change (-1: never, none).
msg::ParameterList list_with(std::int64_t changed_tick, std::int64_t pending_tick, std::uint32_t epoch = 1) {
  msg::ParameterList list{};
  list.header.epoch = epoch;
  list.count = 1;
  dds::set_text(list.parameters[0].name, std::string(kName));
  list.parameters[0].changed_tick = changed_tick;
  list.parameters[0].pending_tick = pending_tick;
  return list;
}

msg::ParameterChange change_for(std::int64_t effective_tick, std::uint32_t epoch = 1) {
  msg::ParameterChange change{};
  change.header.epoch = epoch;
  dds::set_text(change.name, std::string(kName));
  change.effective_tick = effective_tick;
  return change;
}

TEST(ParameterChanges, AreTakenWhenTheyAreInForceOrWaitForTheirTick) {
  const msg::ParameterChange change = change_for(100);
  EXPECT_FALSE(has_taken(list_with(-1, -1), change));
  EXPECT_FALSE(has_taken(list_with(60, -1), change)) << "an earlier change is in force";
  EXPECT_TRUE(has_taken(list_with(60, 100), change));
  EXPECT_TRUE(has_taken(list_with(100, -1), change));
  EXPECT_TRUE(has_taken(list_with(101, -1), change)) << "the owner steps every other tick";
}

TEST(ParameterChanges, ThatWaitBehindAnEarlierOneAreTaken) {
  EXPECT_TRUE(has_taken(list_with(-1, 80), change_for(100))) << "a list shows the next change only";
  EXPECT_FALSE(has_taken(list_with(-1, 200), change_for(100))) << "this one would be the next";
}

TEST(ParameterChanges, EndWithTheirEpoch) {
  EXPECT_TRUE(has_taken(list_with(-1, -1, 2), change_for(100, 1))) << "the reset has undone it";
  EXPECT_FALSE(has_taken(list_with(150, -1, 1), change_for(100, 2))) << "a list from before the reset";
}

TEST(ParameterChanges, DoNotConcernTheListsOfOtherComponents) {
  EXPECT_TRUE(has_taken(msg::ParameterList{}, change_for(100)));
  msg::ParameterList damaged = list_with(-1, -1);
  damaged.count = 60000;  // of a stranger
  EXPECT_FALSE(has_taken(damaged, change_for(100)));
}

std::string suggestion_for(const std::string& name) {
  std::map<std::string, OwnedParameter> known;
  for (const char* each : {"control.motion.carry.method", "control.motion.creep.method", "control.motion.travel.method",
                           "control.motion.travel.amplitude_rad", "navigation.law", "navigation.travel.speed_m_s"})
    known[each] = {};
  for (const char* each : {"a", "b", "c", "d", "e", "f", "g", "h"})
    known[std::string("guidance.") + each + ".radius_m"] = {};
  return did_you_mean(name, known);
}

TEST(UnknownParameter, SuggestsThoseWithTheSameLastPart) {
  const std::string methods =
      ", did you mean one of 'control.motion.carry.method', 'control.motion.creep.method', "
      "'control.motion.travel.method'?";
  EXPECT_EQ(suggestion_for("control.method"), methods);
  EXPECT_EQ(suggestion_for("control.motion.grasp.method"), methods);
  EXPECT_EQ(suggestion_for("control.amplitude_rad"), ", did you mean 'control.motion.travel.amplitude_rad'?");
  EXPECT_EQ(suggestion_for("guidance.radius_m"),
            ", did you mean one of 'guidance.a.radius_m', 'guidance.b.radius_m', 'guidance.c.radius_m', "
            "'guidance.d.radius_m', 'guidance.e.radius_m', 'guidance.f.radius_m' or 2 more?");
}

TEST(UnknownParameter, SuggestsTheOneThatIsMisspelt) {
  EXPECT_EQ(suggestion_for("control.motion.travle.method"), ", did you mean 'control.motion.travel.method'?");
  EXPECT_EQ(suggestion_for("navigation.travel.speed"), ", did you mean 'navigation.travel.speed_m_s'?");
  EXPECT_EQ(suggestion_for("navigation.travl.sped_m_s"), ", did you mean 'navigation.travel.speed_m_s'?");
  EXPECT_EQ(suggestion_for("method"), "");
  EXPECT_EQ(suggestion_for(""), "");
  EXPECT_EQ(suggestion_for("planner.method"), "");
  EXPECT_EQ(suggestion_for("navigation.law"), "") << "it is known";
}

}  // namespace
}  // namespace constrictor
