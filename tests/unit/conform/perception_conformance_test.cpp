// The project's own perception passes; each of many faults of perceptions is found, and the first check that fails
// names it.
#include <gtest/gtest.h>

#include "conform/perception_conformance.hpp"
#include "support/faulty_perceptions.hpp"
#include "support/local_part.hpp"
#include "support/project.hpp"
#include "unit/conform/part_report.hpp"

namespace constrictor::conform {
namespace {

Report examine_perception(const std::string& fault) {
  Setup setup;
  setup.robot_file = testing::robot_path("mamba");
  const RobotModel robot = load_robot(setup.robot_file);
  const PerceptionProfile profile;
  testing::LocalPart port("perception", testing::faulty_perception(fault), setup);
  Report report(perception_checks());
  PerceptionConformance(port, robot, profile, report).run();
  return report;
}

TEST(PerceptionConformance, OurPerceptionPassesEveryCheck) {
  const Report report = examine_perception("");
  EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  EXPECT_EQ(report.count(Verdict::kPassed), perception_checks().size()) << testing::text_of(report);
}

class FindsTheFaultOfAPerception : public ::testing::TestWithParam<testing::NamedFault> {};

TEST_P(FindsTheFaultOfAPerception, AndNamesIt) {
  testing::expect_named(examine_perception(GetParam().fault), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Perceptions, FindsTheFaultOfAPerception, ::testing::ValuesIn(testing::perception_faults()),
                         [](const auto& test) { return std::string(test.param.fault); });

// The drawing and what it says of itself agree: the end of an arc lies on it, and points beside it do not.
TEST(PaintedLine, KnowsItsOwnDistance) {
  for (const double bend : {0.0, 0.7, -1.3}) {
    PaintedLine line;
    line.curvature_1_m = bend;
    line.heading_rad = 0.4;
    line.length_m = 1.5;
    for (const double length : {0.01, 0.6, 1.49}) {
      const Eigen::Vector2d on = line.at(length),
                            left(-std::sin(line.heading_at(length)), std::cos(line.heading_at(length)));
      EXPECT_NEAR(line.distance_m(on), 0.0, 1e-9) << bend;
      EXPECT_NEAR(line.distance_m(on + 0.03 * left), 0.03, 1e-9) << bend;
    }
    EXPECT_GT(line.distance_m(line.at(1.5) +
                              0.1 * Eigen::Vector2d(std::cos(line.heading_at(1.5)), std::sin(line.heading_at(1.5)))),
              1.0);
  }
}

}  // namespace
}  // namespace constrictor::conform
