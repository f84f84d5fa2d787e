// The simulated camera in the simulated robot passes; each of many faults of cameras is found, and the first check that
// fails names it.
#include <gtest/gtest.h>

#include "component/data_path.hpp"
#include "conform/camera_conformance.hpp"
#include "conform/image_motion.hpp"
#include "sim/physics/physics.hpp"
#include "support/faulty_cameras.hpp"
#include "support/local_part.hpp"
#include "unit/conform/part_report.hpp"

namespace constrictor::conform {
namespace {

Report examine_camera(const std::string& fault, bool may_move = true) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/line.yaml");
  const RobotModel robot = load_robot(setup.robot_file);
  CameraProfile profile;
  profile.colour = msg::kColourBlue;
  profile.watch_s = 1.2;
  profile.settle_s = 0.5;
  profile.patience_s = 2.0;
  testing::LocalPart port("camera", testing::faulty_camera(fault), setup, {make_physics_factory()});
  Report report(camera_checks());
  CameraConformance(port, robot, profile, may_move, report).run();
  return report;
}

TEST(CameraConformance, TheSimulatedCameraPassesEveryCheck) {
  const Report report = examine_camera("");
  EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  EXPECT_EQ(report.count(Verdict::kPassed), camera_checks().size()) << testing::text_of(report);
}

TEST(CameraConformance, AnObserverMovesNothing) {
  const Report report = examine_camera("", false);
  EXPECT_TRUE(report.conforms()) << testing::text_of(report);
  EXPECT_EQ(report.check("mirrored").verdict, Verdict::kSkipped);
}

class FindsTheFaultOfACamera : public ::testing::TestWithParam<testing::NamedFault> {};

TEST_P(FindsTheFaultOfACamera, AndNamesIt) { testing::expect_named(examine_camera(GetParam().fault), GetParam()); }

INSTANTIATE_TEST_SUITE_P(Cameras, FindsTheFaultOfACamera, ::testing::ValuesIn(testing::camera_faults()),
                         [](const auto& test) { return std::string(test.param.fault); });

// A point at the centre of the image of a camera that looks ahead moves to the right by f tan(angle) when the head
// turns left.
TEST(ImageMotion, MeasuresAKnownShift) {
  msg::CameraInfo info{};
  info.width = 160;
  info.height = 120;
  info.fx = info.fy = 100.0;
  info.cx = 80.0;
  info.cy = 60.0;
  info.X_HC.orientation = {0.5, -0.5, 0.5, -0.5};  // z ahead, x right, y down
  cv::Mat before(120, 160, CV_32F, cv::Scalar(0.5)), after = before.clone();
  const auto blot = [](cv::Mat& image, int u) { image(cv::Rect(u - 4, 52, 8, 8)) = 1.0F; };
  blot(before, 80);
  blot(after, 80 + 20);
  const ImageMotion motion = image_motion(before, after, info, Eigen::Vector3d::UnitZ(), 0.4);
  EXPECT_NEAR(motion.angle_rad, std::atan(0.2), 0.015);
  EXPECT_GT(motion.likeness, motion.at_rest);
}

}  // namespace
}  // namespace constrictor::conform
