// The project's own planner passes; each of many faults of planners is found, and the first check that fails names it.
#include <gtest/gtest.h>

#include "configuration/configuration.hpp"
#include "conform/planner_conformance.hpp"
#include "support/faulty_planners.hpp"
#include "support/local_part.hpp"
#include "support/project.hpp"
#include "unit/conform/part_report.hpp"

namespace constrictor::conform {
namespace {

Report examine_planner(const std::string& fault,
                       const std::string& mission = "{sequence: [green, red], line_colour: blue}") {
  Setup setup;
  setup.robot_file = testing::robot_path("mamba");
  setup.mission = mission;
  const PlannerProfile profile;
  testing::LocalPart port("planner", testing::faulty_planner(fault), setup);
  Report report(planner_checks());
  PlannerConformance(port, mission_of(mission), profile, report).run();
  return report;
}

TEST(PlannerConformance, OurPlannerPassesEveryCheck) {
  const Report report = examine_planner("");
  EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  EXPECT_EQ(report.count(Verdict::kPassed), planner_checks().size()) << testing::text_of(report);
}

TEST(PlannerConformance, OtherMissionsPass) {
  for (const char* mission :
       {"{sequence: [red], line_colour: blue}", "{sequence: [yellow, green, red], line_colour: blue}"}) {
    const Report report = examine_planner("", mission);
    EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  }
}

TEST(PlannerConformance, RefusesAMissionOfUnknownColours) {
  EXPECT_THROW(static_cast<void>(mission_of("{sequence: [pink], line_colour: blue}")), ConfigurationError);
}

class FindsTheFaultOfAPlanner : public ::testing::TestWithParam<testing::NamedFault> {};

TEST_P(FindsTheFaultOfAPlanner, AndNamesIt) { testing::expect_named(examine_planner(GetParam().fault), GetParam()); }

INSTANTIATE_TEST_SUITE_P(Planners, FindsTheFaultOfAPlanner, ::testing::ValuesIn(testing::planner_faults()),
                         [](const auto& test) { return std::string(test.param.fault); });

}  // namespace
}  // namespace constrictor::conform
