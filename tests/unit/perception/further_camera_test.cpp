// Percepts of further cameras: where their view is, what they see from there, and what their own body hides.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "perception/further_view.hpp"
#include "perception/perception.hpp"
#include "ray_caster.hpp"
#include "robot/camera_mount.hpp"
#include "robot/pose_message.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

constexpr double kTilt_rad = 0.3;
constexpr double kRadius_m = 0.035, kLength_m = 0.089;

/// A camera on a module of mamba, 0.08 m above its axis.
CameraModel camera_on(std::size_t module, double yaw_rad) {
  CameraModel camera;
  camera.module = module;
  camera.p_HC = {-0.02, 0.01, 0.08};
  camera.yaw_rad = yaw_rad;
  camera.tilt_rad = kTilt_rad;
  return camera;
}

msg::CameraInfo info_of(const CameraModel& camera, std::uint8_t number) {
  msg::CameraInfo info = testing::camera_info();
  info.camera = number;
  info.module_index = static_cast<std::uint8_t>(camera.module);
  info.X_HC = pose_message(camera_mount(camera));
  return info;
}

/// What the camera sees of a scene that is given in the frame V of its view: as a camera of that height and tilt on a
/// level head.
cv::Mat picture_in_view(const testing::Scene& scene) {
  msg::CameraInfo info = testing::camera_info();
  info.X_HC.position_m = {0.0, 0.0, 0.08};
  return testing::draw(scene, info, {}, kTilt_rad);
}

RobotModel mamba() { return load_robot(data_path("components/lib/robot/mamba.yaml")); }

TEST(FurtherView, FollowsFromTheJointsAndTheMount) {
  const RobotModel robot = mamba();
  std::vector<double> angles(robot.joints.size(), 0.0);
  angles[0] = 0.4;   // yaw joint between the head and module 1
  angles[2] = -0.9;  // between the modules 2 and 3
  // The plane geometry by hand. A positive angle turns the head side to the left, and so the tail side to the right.
  const double yaw_1 = -0.4, yaw_3 = -0.4 + 0.9;
  const Eigen::Vector2d half(0.5 * kLength_m, 0.0);
  const auto turn = [](double a, const Eigen::Vector2d& p) {
    return Eigen::Vector2d(std::cos(a) * p.x() - std::sin(a) * p.y(), std::sin(a) * p.x() + std::cos(a) * p.y());
  };
  const Eigen::Vector2d p_M3 = -half - turn(yaw_1, 4.0 * half) - turn(yaw_3, half);
  const Eigen::Vector2d expected = p_M3 + turn(yaw_3, {-0.02, 0.01});
  const auto view = perception::further_view(info_of(camera_on(3, 1.2), 1), robot, {1.0, 0.0, 0.0, 0.0}, angles);
  EXPECT_NEAR(view.X_GV.p.x(), expected.x(), 1e-12);
  EXPECT_NEAR(view.X_GV.p.y(), expected.y(), 1e-12);
  EXPECT_NEAR(view.X_GV.yaw_rad, yaw_3 + 1.2, 1e-12);
  EXPECT_NEAR(view.camera.height_m(), kRadius_m + 0.08, 1e-12);
  EXPECT_NEAR(view.camera.position_on_ground().norm(), 0.0, 1e-12);
  // The middle of the image is straight ahead in V, at the height over the tangent of the tilt.
  const auto middle = view.camera.ground(160.0, 120.0);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x(), (kRadius_m + 0.08) / std::tan(kTilt_rad), 1e-9);
  EXPECT_NEAR(middle->y(), 0.0, 1e-9);
}

// A head that pitches and rolls: points of the ground that project to a pixel come back from it, and the yaw of the
// inertial unit does not matter.
TEST(FurtherView, UsesRollAndPitchAndNoYaw) {
  const RobotModel robot = mamba();
  const std::vector<double> angles(robot.joints.size(), 0.05);
  testing::Head head{0.03, -0.04, 0.7};
  const auto info = info_of(camera_on(4, -2.0), 1);
  const auto view = perception::further_view(info, robot, testing::orientation(head), angles);
  head.yaw_rad = -1.9;
  const auto turned = perception::further_view(info, robot, testing::orientation(head), angles);
  EXPECT_NEAR((turned.X_GV.p - view.X_GV.p).norm(), 0.0, 1e-12);
  EXPECT_NEAR(turned.X_GV.yaw_rad, view.X_GV.yaw_rad, 1e-12);
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0.5, 0.1), Eigen::Vector2d(1.2, -0.6)}) {
    const auto pixel = view.camera.pixel(p);
    ASSERT_TRUE(pixel);
    const auto back = view.camera.ground(pixel->x(), pixel->y());
    ASSERT_TRUE(back);
    EXPECT_NEAR((*back - p).norm(), 0.0, 1e-9);
  }
}

TEST(FurtherView, KnowsWhichPixelsShowTheOwnBody) {
  const RobotModel robot = mamba();
  const std::vector<double> angles(robot.joints.size(), 0.0);
  const auto view = perception::further_view(info_of(camera_on(0, std::numbers::pi), 1), robot, {1, 0, 0, 0}, angles);
  ASSERT_TRUE(view.camera.sees_body());
  // A straight body lies behind the head: along +x of V, 0.01 m to the side of the camera, up to 0.07 m high. The
  // camera is 0.115 m above the ground: it sees nothing of the body above the line of sight to the tail.
  const auto shows = [&](double x, double y, double z) {
    const auto pixel = view.camera.pixel(Eigen::Vector3d(x, y, z));
    return pixel && view.camera.own_body(pixel->x(), pixel->y());
  };
  for (const double x : {0.2, 0.5, 1.5}) {
    EXPECT_TRUE(shows(x, 0.01, 0.06)) << x;
    EXPECT_FALSE(shows(x, 0.01, 0.13)) << x;
    EXPECT_TRUE(shows(x, 0.03, 0.035)) << x;
    EXPECT_FALSE(shows(x, 0.01 + 0.1, 0.035)) << x;
    EXPECT_FALSE(shows(x, 0.01 - 0.1, 0.035)) << x;
  }
  EXPECT_TRUE(shows(2.5, 0.0, 0.0)) << "the body hides the ground behind it";
  EXPECT_FALSE(shows(1.0, 0.5, 0.0));
}

/// Measures what is in a picture of this camera.
perception::Percepts look(const perception::GroundCamera& camera, const cv::Mat& picture,
                          const perception::ObjectSizes& sizes = {}) {
  static perception::LineAndBlobDetector detector{perception::PerceptionConfig{}};
  return detector.detect(picture, camera, msg::kColourBlue, sizes);
}

// The body covers the right half of the object, as a grey plane in front of it.
TEST(FurtherView, ASideThatTheBodyHidesCountsAsCut) {
  const RobotModel robot = mamba();
  const std::vector<double> straight(robot.joints.size(), 0.0);
  const auto view = perception::further_view(info_of(camera_on(0, std::numbers::pi), 1), robot, {1, 0, 0, 0}, straight);
  testing::Scene scene;
  scene.rounds = {{msg::kColourRed, {1.0, 0.07}, 0.15}};  // a zone beside the body, which covers one side of it
  cv::Mat picture = picture_in_view(scene);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      if (view.camera.own_body(u + 0.5, v + 0.5)) picture.at<cv::Vec3b>(v, u) = {120, 120, 120};
    }
  }
  const perception::Percepts percepts = look(view.camera, picture);
  int zones = 0;
  for (int i = 0; i < percepts.objects.blob_count; ++i) {
    const msg::Blob& blob = percepts.objects.blobs[i];
    if (blob.kind != msg::kBlobZone) continue;
    ++zones;
    EXPECT_TRUE(blob.cut_right || blob.cut_left) << "its centre cannot be seen";
  }
  EXPECT_GE(zones, 1);
}

/// The robot file of a test, with a camera to the right on module 3.
class PerceptionOfFurtherCameras : public ::testing::Test {
 protected:
  static constexpr double kYaw_rad = -1.2;
  PerceptionOfFurtherCameras() {
    std::ifstream original(data_path("components/lib/robot/mamba.yaml"));
    std::ostringstream text;
    text << original.rdbuf()
         << "further_cameras: [{name: right, module: 3, position_m: [-0.02, 0.01, 0.08], yaw_rad: -1.2, tilt_rad: 0.3}]"
            "\n";
    setup_.robot_file = folder_.path() / "robot.yaml";
    std::ofstream(setup_.robot_file) << text.str();
  }

  /// The yaw joint between head and module 1, which moves quickly: an image is understood only with the angles of its
  /// exposure.
  static double angle(std::int64_t tick) { return 0.5 * std::sin(0.9 * static_cast<double>(tick)); }

  static ComponentFactory body() {
    return testing::scripted_plant([](Wiring& wiring) -> testing::StepFunction {
      return [joints = wiring.output(topics::kJointState), imu = wiring.output(topics::kImuState)](const Tick& tick) {
        msg::JointState state{};
        state.joint_count = 23;
        state.position_rad[0] = angle(tick.index);
        joints.write(state);
        msg::ImuState attitude{};
        attitude.orientation = testing::orientation({});
        imu.write(attitude);
      };
    });
  }

  /// The camera: the image of tick 15 has the number of a camera that the robot has not.
  static ComponentFactory eye() {
    return testing::scripted_member("camera",
                                    [](Wiring& wiring) -> testing::StepFunction {
                                      return [infos = wiring.output(topics::kFurtherCameraInfo),
                                              images = wiring.output(topics::kFurtherCameraImage)](const Tick& tick) {
                                        if (tick.index == 0) infos.write(info_of(camera_on(3, kYaw_rad), 1));
                                        testing::Scene scene;
                                        scene.line = testing::Arc{{0.2, -0.1}, 0.0, 0.0};
                                        scene.rounds = {{msg::kColourYellow, {0.9, 0.3}, 0.08, 0.2}};
                                        scene.seed = static_cast<std::uint64_t>(tick.index) + 1;
                                        scene.noise_sd = 0.01;
                                        cv::Mat picture = picture_in_view(scene);
                                        msg::CameraImage image{};
                                        image.camera = tick.index == 15 ? 2 : 1;
                                        image.width = static_cast<std::uint16_t>(picture.cols);
                                        image.height = static_cast<std::uint16_t>(picture.rows);
                                        image.exposure_tick = tick.index;
                                        image.data._buffer = picture.data;
                                        image.data._length = image.data._maximum =
                                            static_cast<std::uint32_t>(3 * picture.rows * picture.cols);
                                        images.write(image);
                                      };
                                    },
                                    {5, 2});
  }

  std::unique_ptr<LocalRun> run() {
    return std::make_unique<LocalRun>(std::vector{body(), eye(), make_perception_factory()}, setup_);
  }

  testing::TemporaryFolder folder_;
  constrictor::Setup setup_;
};

TEST_F(PerceptionOfFurtherCameras, AreWhereTheSceneIs) {
  auto local = run();
  int lines = 0, objects = 0, pictures = 0;
  const auto check_view = [](const auto& percept) {
    EXPECT_EQ(percept.camera, 1);
    EXPECT_EQ(percept.header.tick, percept.exposure_tick + 2);
    const double yaw = -angle(percept.exposure_tick);  // of the body behind the joint
    const Eigen::Vector2d half(0.5 * kLength_m, 0.0);
    const Eigen::Vector2d p = -half - turned(5.0 * half, yaw) + turned({-0.02, 0.01}, yaw);
    EXPECT_NEAR(percept.X_GV.x_m, p.x(), 1e-9);
    EXPECT_NEAR(percept.X_GV.y_m, p.y(), 1e-9);
    EXPECT_NEAR(percept.X_GV.yaw_rad, yaw + kYaw_rad, 1e-9);
  };
  local->subscribe<msg::LinePercept>(topics::kFurtherLinePercept, [&](const msg::LinePercept& line) {
    ++lines;
    check_view(line);
    ASSERT_TRUE(line.visible);
    EXPECT_NEAR(line.offset_m, -0.1, 0.015);
    EXPECT_NEAR(line.heading_rad, 0.0, 0.06);
  });
  local->subscribe<msg::ObjectPercepts>(topics::kFurtherObjectPercepts, [&](const msg::ObjectPercepts& percepts) {
    ++objects;
    check_view(percepts);
    ASSERT_EQ(percepts.blob_count, 1);
    const msg::Blob& blob = percepts.blobs[0];
    EXPECT_EQ(blob.kind, msg::kBlobObject);
    EXPECT_NEAR(blob.bearing_rad, std::atan2(0.3, 0.9), 0.01);
    EXPECT_NEAR(blob.range_m, std::hypot(0.9, 0.3) - 0.08, 0.03);
    EXPECT_NEAR(blob.width_m, 0.16, 0.02);
  });
  local->subscribe<msg::CameraImage>(topics::kFurtherProcessedImage, [&](const msg::CameraImage& image) {
    ++pictures;
    EXPECT_EQ(image.camera, 1);
  });
  local->advance(40);
  EXPECT_EQ(lines, 7);  // exposures at the ticks 0 to 35; the one of tick 15 is refused
  EXPECT_EQ(objects, 7);
  EXPECT_EQ(pictures, 2) << "every 5th is drawn: those of the ticks 0 and 30";
  EXPECT_EQ(local->member("perception").counters().last_refusal,
            "camera/further/image.camera: found 2, accepted 1 to 1, the further cameras of the robot");
  EXPECT_EQ(local->latest(topics::kLinePercept), nullptr) << "the head's camera has written nothing";
}

TEST_F(PerceptionOfFurtherCameras, RestartChangesNothing) {
  auto whole = run(), broken = run();
  whole->advance(40);
  for (int i = 0; i < 40; ++i) {
    broken->advance(1);
    if (i == 6 || i == 21 || i == 22) broken->restart("perception");
  }
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
}

}  // namespace
}  // namespace constrictor
