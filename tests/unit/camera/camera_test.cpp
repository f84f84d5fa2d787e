// The components `camera` and `overview` in a run with a scripted plant.
#include "sim/camera/camera.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "scene_plant.hpp"
#include "sim/overview/overview.hpp"

namespace constrictor {
namespace {

Setup setup_with_seed(std::uint64_t seed) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.seed = seed;
  return setup;
}

struct Frame {
  std::int64_t written;
  std::int64_t exposed;
  std::vector<std::uint8_t> data;
  bool operator==(const Frame&) const = default;
};

template <class T>
void collect(LocalRun& run, const Topic<T>& topic, std::vector<Frame>& frames) {
  run.subscribe<T>(topic, [&frames](const T& image) {
    frames.push_back(
        {image.header.tick, image.exposure_tick, {image.data._buffer, image.data._buffer + image.data._length}});
  });
}

TEST(Camera, WritesAnImageEveryPeriodAndItsModelOnce) {
  LocalRun run({testing::scene_plant_factory(), make_camera_factory()}, setup_with_seed(1));
  std::vector<Frame> frames;
  int infos = 0;
  collect(run, topics::kCameraImage, frames);
  run.subscribe<msg::CameraInfo>(topics::kCameraInfo, [&](const msg::CameraInfo&) { ++infos; });
  const CameraModel camera = load_robot(setup_with_seed(1).robot_file).camera;
  run.advance(3 * camera.period_ticks + 1);
  EXPECT_EQ(infos, 1);
  ASSERT_EQ(frames.size(), 4U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].written, static_cast<std::int64_t>(i) * camera.period_ticks);
    EXPECT_EQ(frames[i].exposed, frames[i].written);
    EXPECT_EQ(frames[i].data.size(), static_cast<std::size_t>(camera.width * camera.height * 3));
  }
  EXPECT_NE(frames[0].data, frames[1].data);
}

TEST(Camera, PublishedModelPredictsWhereAnObjectAppears) {
  LocalRun run({testing::scene_plant_factory(), make_camera_factory()}, setup_with_seed(3));
  run.advance(51);
  const msg::CameraInfo* info = run.latest(topics::kCameraInfo);
  const msg::CameraImage* image = run.latest(topics::kCameraImage);
  ASSERT_NE(info, nullptr);
  ASSERT_NE(image, nullptr);
  // Computed from the message alone: from the world to the head, to the camera, to the pixel.
  const auto isometry = [](const msg::Pose3& pose) {
    const auto& [w, x, y, z] = pose.orientation;
    Eigen::Matrix3d R;
    R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
        1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    return std::pair{R, Eigen::Vector3d(pose.position_m.x, pose.position_m.y, pose.position_m.z)};
  };
  const auto [R_WH, p_WH] = isometry(testing::ScenePlant::head_pose(1.0));
  const auto [R_HC, p_HC] = isometry(info->X_HC);
  for (int i = 0; i < 2; ++i) {
    const auto position = testing::ScenePlant::object_pose(i).position_m;
    const Eigen::Vector3d p_H = R_WH.transpose() * (Eigen::Vector3d(position.x, position.y, position.z) - p_WH);
    const Eigen::Vector3d p_C = R_HC.transpose() * (p_H - p_HC);
    const double u = info->fx * p_C.x() / p_C.z() + info->cx;
    const double v = info->fy * p_C.y() / p_C.z() + info->cy;
    double sum_u = 0, sum_v = 0, count = 0;
    for (int row = 0; row < image->height; ++row) {
      for (int column = 0; column < image->width; ++column) {
        const std::uint8_t* pixel = image->data._buffer + 3 * (row * image->width + column);
        const int wanted = pixel[i == 0 ? 1 : 0];
        if (wanted < pixel[i == 0 ? 0 : 1] + 50 || wanted < pixel[2] + 40) continue;
        sum_u += column + 0.5;
        sum_v += row + 0.5;
        ++count;
      }
    }
    ASSERT_GT(count, 50);
    EXPECT_NEAR(sum_u / count, u, 1.0);
    EXPECT_NEAR(sum_v / count, v,
                1.5);  // the visible half of a cylinder is nearer than its centre
  }
}

TEST(Camera, NoiseDependsOnTheSeed) {
  const auto image_of = [](std::uint64_t seed) {
    LocalRun run({testing::scene_plant_factory(), make_camera_factory()}, setup_with_seed(seed));
    std::vector<Frame> frames;
    collect(run, topics::kCameraImage, frames);
    run.advance(1);
    return frames.at(0).data;
  };
  EXPECT_EQ(image_of(1), image_of(1));
  EXPECT_NE(image_of(1), image_of(2));
}

TEST(Camera, RestartedProcessesWriteTheSameImages) {
  const auto run_with_restarts = [](const std::vector<std::pair<std::int64_t, std::string>>& restarts) {
    LocalRun run({testing::scene_plant_factory(), make_camera_factory(), make_overview_factory()}, setup_with_seed(7));
    std::vector<Frame> frames;
    collect(run, topics::kCameraImage, frames);
    collect(run, topics::kOverviewImage, frames);
    for (const auto& [tick, component] : restarts) {
      run.advance(tick - run.tick());
      run.restart(component);
    }
    run.advance(115 - run.tick());
    return std::pair{frames, run.output_hashes()};
  };
  const auto reference = run_with_restarts({});
  const auto restarted =
      run_with_restarts({{3, "camera"}, {26, "camera"}, {60, "overview"}, {72, "camera"}, {101, "overview"}});
  EXPECT_EQ(reference.first, restarted.first);
  EXPECT_EQ(reference.second, restarted.second);
}

TEST(Overview, ShowsZonesObjectsAndLineFromAFixedViewpoint) {
  LocalRun run({testing::scene_plant_factory(), make_overview_factory()}, setup_with_seed(1));
  std::vector<Frame> frames;
  collect(run, topics::kOverviewImage, frames);
  run.advance(101);
  ASSERT_EQ(frames.size(), 3U);
  const auto configuration = load_parameters<OverviewConfig>(data_path("sim/overview/overview.yaml"));
  ASSERT_EQ(frames[0].data.size(), static_cast<std::size_t>(configuration.width * configuration.height * 3));
  int green = 0, red = 0, blue = 0, changed = 0;
  for (std::size_t i = 0; i < frames[0].data.size(); i += 3) {
    const int r = frames[0].data[i], g = frames[0].data[i + 1], b = frames[0].data[i + 2];
    green += g > r + 50 && g > b + 50;
    red += r > g + 50 && r > b + 50;
    blue += b > r + 50 && b > g + 50;
    changed += frames[2].data[i] != r || frames[2].data[i + 1] != g || frames[2].data[i + 2] != b;
  }
  EXPECT_GT(green, 100);
  EXPECT_GT(red, 100);
  EXPECT_GT(blue, 300);
  EXPECT_GT(changed, 100);                                             // the robot has moved
  EXPECT_LT(changed, configuration.width * configuration.height / 5);  // the camera has not moved
}

}  // namespace
}  // namespace constrictor
