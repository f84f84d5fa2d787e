// Which objects a mission may demand of a robot.
#include "navigation/object_limits.hpp"

#include <gtest/gtest.h>

#include "component/data_path.hpp"
#include "navigation/navigation_fit.hpp"
#include "task_setting.hpp"

namespace constrictor {
namespace {

class ObjectLimits : public ::testing::Test {
 protected:
  static DemandedObject cylinder(double radius_m, double height_m = 0.15) {
    return {"objects[0]", false, 2.0 * radius_m, 2.0 * radius_m, height_m, "zones[0]", 0.4};
  }
  static DemandedObject box(double width_m, double length_m, double height_m = 0.15) {
    return {"objects[0]", true, width_m, length_m, height_m, "zones[0]", 0.4};
  }
  [[nodiscard]] CheckVerdict judge(const DemandedObject& object) const {
    return judge_object(GripSense(robot_, config_.grip), robot_, object);
  }
  /// Whether an object is accepted without a warning, with one, or refused.
  [[nodiscard]] std::string verdict(const DemandedObject& object) const {
    const CheckVerdict found = judge(object);
    return !found.refusals.empty() ? "refused" : !found.warnings.empty() ? "warned" : "accepted";
  }

  RobotModel robot_ = load_robot(data_path("components/lib/robot/mamba.yaml"));
  NavigationConfig config_ = navigation_fitted_to(robot_, {});
};

TEST_F(ObjectLimits, ACylinderFitsIntoTheU) {
  EXPECT_EQ(verdict(cylinder(0.119)), "accepted");
  ASSERT_EQ(judge(cylinder(0.12)).refusals.size(), 1u);
  EXPECT_EQ(judge(cylinder(0.12)).refusals[0],
            "objects[0].radius_m: found 0.120 m, accepted at most 0.119 m: the U of mamba holds no larger object");
}

// Missions of `short` with a box in place of the cylinder, at 0.4 and 0.785 rad, four seeds each.
TEST_F(ObjectLimits, ABoxIsJudgedByItsDiagonal) {
  EXPECT_EQ(verdict(box(0.15, 0.15)), "accepted");
  EXPECT_EQ(verdict(box(0.17, 0.17)), "accepted") << "8 of 8 missions";
  EXPECT_EQ(verdict(box(0.19, 0.19)), "warned") << "7 of 8";
  EXPECT_EQ(verdict(box(0.20, 0.20)), "warned") << "5 of 8";
  EXPECT_EQ(verdict(box(0.21, 0.21)), "refused") << "1 of 8";
  EXPECT_EQ(verdict(box(0.23, 0.23)), "refused");
  EXPECT_NE(
      judge(box(0.21, 0.21)).refusals[0].find("objects[0].size_m: found a diagonal of 0.297 m, accepted at most "),
      std::string::npos);
}

TEST_F(ObjectLimits, ALongBoxMustNotLookWiderThanTheU) {
  EXPECT_EQ(verdict(box(0.1, 0.2)), "accepted") << "3 of 3 missions";
  EXPECT_EQ(verdict(box(0.1, 0.25)), "warned") << "1 of 3";
  EXPECT_EQ(verdict(box(0.08, 0.3)), "refused") << "0 of 3";
  EXPECT_EQ(verdict(box(0.1, 0.4)), "refused");
  EXPECT_EQ(verdict(box(0.07, 0.26)), "refused") << "its diagonal is that of a square of 0.19 m";
}

// Missions of `short`, four seeds each.
TEST_F(ObjectLimits, ASlenderObjectFallsOver) {
  EXPECT_EQ(verdict(cylinder(0.0496, 0.30)), "accepted") << "the narrowest and highest object of `wide`";
  EXPECT_EQ(verdict(cylinder(0.085, 0.50)), "accepted");
  EXPECT_EQ(verdict(cylinder(0.05, 0.40)), "warned") << "3 of 4 missions";
  EXPECT_EQ(verdict(cylinder(0.04, 0.32)), "warned") << "2 of 4";
  EXPECT_EQ(verdict(cylinder(0.03, 0.30)), "refused") << "0 of 4";
  EXPECT_EQ(verdict(cylinder(0.04, 0.40)), "refused") << "0 of 4";
  EXPECT_EQ(verdict(box(0.06, 0.1, 0.30)), "refused") << "it falls over its longer edge";
  EXPECT_EQ(judge(cylinder(0.04, 0.40)).refusals[0],
            "objects[0].height_m: found a height of 0.400 m, accepted at most 0.360 m for a width of 0.080 m: the "
            "object falls over when the body meets it, and no U holds one that lies");
}

TEST_F(ObjectLimits, ANarrowObjectIsLost) {
  EXPECT_EQ(verdict(cylinder(0.03, 0.08)), "accepted") << "3 of 3 missions";
  EXPECT_EQ(verdict(cylinder(0.02, 0.08)), "warned") << "3 of 3";
  EXPECT_EQ(verdict(cylinder(0.02, 0.12)), "warned") << "1 of 4";
  EXPECT_EQ(verdict(cylinder(0.015, 0.05)), "refused") << "0 of 3";
  EXPECT_EQ(verdict(cylinder(0.006, 0.05)), "refused") << "0 of 3";
  EXPECT_EQ(verdict(box(0.05, 0.15, 0.1)), "warned") << "3 of 3";
  EXPECT_EQ(judge(cylinder(0.015, 0.05)).refusals[0],
            "objects[0].radius_m: found a width of 0.030 m, accepted at least 0.035 m: the U of mamba loses a narrower "
            "object");
}

TEST_F(ObjectLimits, TheBodySlidesOverAPlate) {
  EXPECT_EQ(verdict(cylinder(0.085, 0.04)), "accepted");
  EXPECT_EQ(judge(cylinder(0.085, 0.03)).refusals[0],
            "objects[0].height_m: found a height of 0.030 m, accepted at least 0.035 m (module.radius_m): the body of "
            "mamba slides over it");
}

/// Why a pregrasp of an object that looks like this is refused.
std::string pregrasp_refusal(double radius_m, double height_m) {
  TaskSetting setting;
  setting.parameters.object_colour = msg::kColourGreen;
  Sighting& object = setting.sightings.objects[msg::kColourGreen];
  object.known = true;
  object.radius_m = radius_m;
  object.height_m = height_m;
  return make_task(msg::kTaskPregrasp)->refusal(setting.input(), {});
}

TEST_F(ObjectLimits, AnObjectThatLooksTooLargeAndLowMayLieOnItsSide) {
  EXPECT_EQ(pregrasp_refusal(0.12, 0.15), "") << "the camera measures to a few percent";
  EXPECT_EQ(pregrasp_refusal(0.15, 0.20),
            "the object is too large for the U: found a radius of 0.150 m, accepted at most 0.119 m");
  EXPECT_EQ(pregrasp_refusal(0.15, 0.0),
            "the object is too large for the U: found a radius of 0.150 m, accepted at most 0.119 m")
      << "the height is unknown";
  // A cylinder of 0.04 x 0.40 m, seen from its side.
  EXPECT_EQ(pregrasp_refusal(0.20, 0.08),
            "the object lies on its side, or is too large for the U: found a radius of 0.200 m, accepted at most 0.119 "
            "m");
}

TEST_F(ObjectLimits, ARobotThatCannotGraspHasOneRefusal) {
  robot_.module_count = 12;
  robot_.joints.resize(11);
  EXPECT_EQ(verdict(cylinder(0.4)), "accepted") << "the mission is refused because of the robot";
}

}  // namespace
}  // namespace constrictor
