// The images of further cameras: when they are written, and what they show.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "scene_plant.hpp"
#include "sim/camera/camera.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

using testing::ScenePlant;

/// A straight robot that turns to and fro, with the objects of ScenePlant behind it.
Eigen::Isometry3d module_pose(double time_s, std::size_t module) {
  Eigen::Isometry3d X_WH = Eigen::Isometry3d::Identity();
  X_WH.linear() = Eigen::AngleAxisd(2.6 + 0.2 * std::sin(time_s), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_WH.translation() = Eigen::Vector3d(0.2 * time_s, 0.1, 0.035);
  return X_WH * Eigen::Translation3d(-0.089 * static_cast<double>(module), 0.0, 0.0);
}

ComponentFactory turning_robot() {
  return testing::scripted_plant([](Wiring& wiring) -> testing::StepFunction {
    return [scene = wiring.output(topics::kSceneDescription),
            worlds = wiring.output(topics::kWorldState)](const Tick& tick) {
      if (tick.index == 0) scene.write(ScenePlant::description(1));
      msg::WorldState world{};
      world.module_count = ScenePlant::kModules;
      for (std::size_t i = 0; i < ScenePlant::kModules; ++i) {
        const Eigen::Isometry3d X = module_pose(tick.time_s(), i);
        const Eigen::Quaterniond q(X.linear());
        world.module_poses[i] = {{X.translation().x(), X.translation().y(), X.translation().z()},
                                 {q.w(), q.x(), q.y(), q.z()}};
      }
      world.object_count = 2;
      for (int i = 0; i < 2; ++i) world.object_poses[i] = ScenePlant::object_pose(i);
      worlds.write(world);
    };
  });
}

/// What the cameras of a robot have written.
struct Album {
  std::map<int, msg::CameraInfo> infos;
  std::map<int, int> info_count;
  std::map<int, std::vector<std::int64_t>> exposures;
  std::map<int, std::vector<std::uint8_t>> newest;
};

class FurtherCameraImages : public ::testing::Test {
 protected:
  FurtherCameraImages() {
    std::ifstream original(data_path("components/lib/robot/mamba.yaml"));
    std::ostringstream text;
    text << original.rdbuf()
         << "further_cameras:\n"
            "  - {name: rear, position_m: [-0.02, 0, 0.08], yaw_rad: 3.14159265, tilt_rad: 0.3}\n"
            "  - {name: side, module: 5, position_m: [0, 0.01, 0.08], yaw_rad: -2.6, tilt_rad: 0.2, width: 200,\n"
            "     height: 150, horizontal_fov_rad: 1.3}\n";
    setup_.robot_file = folder_.path() / "robot.yaml";
    std::ofstream(setup_.robot_file) << text.str();
  }

  std::unique_ptr<LocalRun> run() {
    auto made = std::make_unique<LocalRun>(std::vector{turning_robot(), make_camera_factory()}, setup_);
    for (const auto& topic : {topics::kCameraInfo, topics::kFurtherCameraInfo}) {
      made->subscribe<msg::CameraInfo>(topic, [this](const msg::CameraInfo& info) {
        album_.infos[info.camera] = info;
        ++album_.info_count[info.camera];
      });
    }
    for (const auto& topic : {topics::kCameraImage, topics::kFurtherCameraImage}) {
      made->subscribe<msg::CameraImage>(topic, [this](const msg::CameraImage& image) {
        album_.exposures[image.camera].push_back(image.exposure_tick);
        album_.newest[image.camera] = {image.data._buffer, image.data._buffer + image.data._length};
      });
    }
    return made;
  }

  testing::TemporaryFolder folder_;
  constrictor::Setup setup_;
  Album album_;
};

TEST_F(FurtherCameraImages, AreExposedAtTheTicksOfTheHeadsCamera) {
  run()->advance(16);
  for (int camera = 0; camera < 3; ++camera) {
    EXPECT_EQ(album_.exposures[camera], (std::vector<std::int64_t>{0, 5, 10, 15})) << camera;
    EXPECT_EQ(album_.info_count[camera], 1) << camera;
  }
  EXPECT_EQ(album_.exposures.size(), 3U);
  EXPECT_EQ(album_.newest[2].size(), 200U * 150U * 3U);
  EXPECT_NE(album_.newest[0], album_.newest[1]);
}

TEST_F(FurtherCameraImages, ShowObjectsWhereModelMountAndBodyPredictThem) {
  run()->advance(51);
  for (const int camera : {1, 2}) {
    const msg::CameraInfo& info = album_.infos[camera];
    EXPECT_EQ(info.module_index, camera == 1 ? 0 : 5);
    // Computed from the message alone: from the world to the module, to the camera, to the pixel.
    const auto& q = info.X_HC.orientation;
    const auto& m = info.X_HC.position_m;
    const Eigen::Isometry3d X_MC = Eigen::Translation3d(m.x, m.y, m.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
    const Eigen::Isometry3d X_WC = module_pose(1.0, info.module_index) * X_MC;
    for (int i = 0; i < 2; ++i) {
      const auto p = ScenePlant::object_pose(i).position_m;
      const Eigen::Vector3d p_C = X_WC.inverse() * Eigen::Vector3d(p.x, p.y, p.z);
      ASSERT_GT(p_C.z(), 0.5);
      const double u = info.fx * p_C.x() / p_C.z() + info.cx, v = info.fy * p_C.y() / p_C.z() + info.cy;
      double sum_u = 0, sum_v = 0, count = 0;
      for (int row = 0; row < info.height; ++row) {
        for (int column = 0; column < info.width; ++column) {
          const std::uint8_t* pixel = album_.newest[camera].data() + 3 * (row * info.width + column);
          const int wanted = pixel[i == 0 ? 1 : 0];
          if (wanted < pixel[i == 0 ? 0 : 1] + 50 || wanted < pixel[2] + 40) continue;
          sum_u += column + 0.5;
          sum_v += row + 0.5;
          ++count;
        }
      }
      ASSERT_GT(count, 50) << camera << ", object " << i;
      EXPECT_NEAR(sum_u / count, u, 1.0) << camera << ", object " << i;
      EXPECT_NEAR(sum_v / count, v, 1.5) << camera << ", object " << i;
    }
  }
}

TEST_F(FurtherCameraImages, LeaveThoseOfTheHeadAsTheyAre) {
  run()->advance(6);
  const auto with = album_.newest[0];
  album_ = {};
  setup_.robot_file = data_path("components/lib/robot/mamba.yaml");
  run()->advance(6);
  EXPECT_EQ(album_.newest[0], with);
  EXPECT_EQ(album_.exposures.size(), 1U);
}

TEST_F(FurtherCameraImages, AreRepeatedAfterARestart) {
  auto whole = run(), broken = run();
  whole->advance(30);
  for (int i = 0; i < 30; ++i) {
    broken->advance(1);
    if (i == 2 || i == 11 || i == 20) broken->restart("camera");
  }
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
}

}  // namespace
}  // namespace constrictor
