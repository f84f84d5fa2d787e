// The project's own control passes; each of many faults of controls is found, and the first check that fails names it.
#include <gtest/gtest.h>

#include <algorithm>

#include "conform/control_conformance.hpp"
#include "control/control.hpp"
#include "support/faulty_controls.hpp"
#include "support/local_part.hpp"
#include "support/project.hpp"
#include "unit/conform/part_report.hpp"

namespace constrictor::conform {
namespace {

Report examine_control(const std::string& fault, long interrupt_at = 0, std::string* gone = nullptr) {
  Setup setup;
  setup.robot_file = testing::robot_path("mamba");
  const RobotModel robot = load_robot(setup.robot_file);
  const ControlProfile profile;
  testing::LocalPart port("control", testing::faulty_control(fault), setup, {}, interrupt_at);
  Report report(control_checks());
  try {
    ControlConformance(port, robot, profile, report).run();
  } catch (const PartGone& error) {
    if (gone != nullptr) *gone = error.what();
  }
  return report;
}

TEST(ControlConformance, OurControlPassesEveryCheck) {
  const Report report = examine_control("");
  EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  EXPECT_EQ(report.count(Verdict::kPassed), control_checks().size()) << testing::text_of(report);
}

TEST(ControlConformance, AnInterruptLeavesTheRestNotChecked) {
  const Report report = examine_control("", 500);
  EXPECT_GT(report.count(Verdict::kPassed), 5u);
  EXPECT_GT(report.count(Verdict::kNotChecked), 5u);
  EXPECT_FALSE(report.conforms());
}

TEST(ControlConformance, AControlThatFallsSilentEndsTheChecksWithTheReason) {
  std::string gone;
  Report report = examine_control("falls_silent", 0, &gone);
  EXPECT_EQ(gone.find("control has stopped writing joint_command: none came for "), 0u) << gone;
  EXPECT_EQ(report.check("rests").verdict, Verdict::kPassed);
  EXPECT_EQ(report.check("stop").verdict, Verdict::kNotChecked);
  EXPECT_FALSE(report.conforms());
  report = examine_control("loses_its_state", 0, &gone);
  EXPECT_EQ(gone.find("control has stopped writing motion_status: none came for "), 0u) << gone;
  EXPECT_FALSE(report.conforms());
}

class FindsTheFaultOfAControl : public ::testing::TestWithParam<testing::NamedFault> {};

TEST_P(FindsTheFaultOfAControl, AndNamesIt) { testing::expect_named(examine_control(GetParam().fault), GetParam()); }

INSTANTIATE_TEST_SUITE_P(Controls, FindsTheFaultOfAControl, ::testing::ValuesIn(testing::control_faults()),
                         [](const auto& test) { return std::string(test.param.fault); });

}  // namespace
}  // namespace constrictor::conform
