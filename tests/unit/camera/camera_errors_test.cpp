// The errors of images against what was asked: moments of the blur, the photometry, the share of dropped images, and
// the width of the motion blur by geometry.
#include "sim/camera/camera_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "scene_plant.hpp"
#include "sim/camera/camera.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

std::vector<std::uint8_t> changed(const CameraErrorConfig& config, std::vector<std::uint8_t> rgb, int width) {
  ImageErrors errors(config);
  errors.begin(1);
  errors.expose(rgb);
  errors.finish(width, rgb);
  return rgb;
}

TEST(CameraErrors, BlurSpreadsLightByItsStandardDeviationAndLosesNone) {
  constexpr int kSize = 61;
  for (const double sd : {1.0, 2.5, 5.0}) {
    CameraErrorConfig config;
    config.blur_pixels = sd;
    std::vector<std::uint8_t> rgb(3 * kSize * kSize, 0);
    for (int v = 28; v <= 32; ++v)
      for (int u = 28; u <= 32; ++u) rgb[static_cast<std::size_t>(3 * (v * kSize + u))] = 255;
    const auto image = changed(config, rgb, kSize);
    double sum = 0, along_u = 0, along_v = 0;
    for (int v = 0; v < kSize; ++v) {
      for (int u = 0; u < kSize; ++u) {
        const double value = image[static_cast<std::size_t>(3 * (v * kSize + u))];
        sum += value * value;
        along_u += value * value * (u - 30) * (u - 30);
        along_v += value * value * (v - 30) * (v - 30);
        EXPECT_EQ(image[static_cast<std::size_t>(3 * (v * kSize + u) + 1)], 0);  // the other channels stay dark
      }
    }
    EXPECT_NEAR(sum / (25.0 * 255 * 255), 1.0, 0.02);
    const double square = 2.0;  // variance of five equally bright pixels: (25 - 1) / 12
    EXPECT_NEAR(along_u / sum, sd * sd + square, 0.04 * (sd * sd + square)) << sd;
    EXPECT_NEAR(along_v / sum, sd * sd + square, 0.04 * (sd * sd + square)) << sd;
  }
}

TEST(CameraErrors, GainsMultiplyTheLightAndContrastTheDistanceFromGrey) {
  CameraErrorConfig config;
  config.gain = 4.0;  // of the light: twice the value
  config.red_gain = 0.25;
  config.blue_gain = 2.0;
  EXPECT_EQ(changed(config, {100, 100, 100, 200, 60, 200}, 2),
            (std::vector<std::uint8_t>{100, 200, 255, 200, 120, 255}));
  config = {};
  config.contrast = 0.5;
  EXPECT_EQ(changed(config, {0, 255, 128}, 1), (std::vector<std::uint8_t>{64, 191, 128}));
  config.contrast = 2.0;
  EXPECT_EQ(changed(config, {100, 200, 60}, 1), (std::vector<std::uint8_t>{73, 255, 0}));
}

TEST(CameraErrors, AnExposureAveragesLightAndNotValues) {
  ImageErrors errors{CameraErrorConfig{}};
  EXPECT_FALSE(errors.change_single_frames());
  errors.begin(2);
  errors.expose({0, 10, 255});
  errors.expose({255, 10, 255});
  std::vector<std::uint8_t> rgb;
  errors.finish(1, rgb);
  EXPECT_EQ(rgb, (std::vector<std::uint8_t>{180, 10, 255}));  // 255 / sqrt(2)
}

TEST(CameraErrors, DropsTheShareThatWasAskedForIndependently) {
  constexpr int kImages = 20000;
  for (const double share : {0.0, 0.1, 0.5, 1.0}) {
    int dropped = 0, pairs = 0, same_with_other_seed = 0;
    for (int i = 0; i < kImages; ++i) {
      const bool now = image_is_dropped(share, 7, 5 * i);
      dropped += now;
      pairs += now && image_is_dropped(share, 7, 5 * i + 5);
      same_with_other_seed += now == image_is_dropped(share, 8, 5 * i);
    }
    const auto within = [&](double count, double p) {
      EXPECT_NEAR(count, kImages * p, 4.5 * std::sqrt(kImages * p * (1 - p)) + 1e-9) << share;
    };
    within(dropped, share);
    within(pairs, share * share);
    within(same_with_other_seed, share * share + (1 - share) * (1 - share));
  }
}

TEST(CameraErrors, BodiesGoOnAsTheyMoved) {
  ScenePoses before, now;
  before.X_WModule = {Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())};
  now.X_WModule = {Eigen::Translation3d(1.2, 2, 2.9) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ())};
  for (const double share : {-1.0, -0.5, 0.0, 1.5}) {
    const Eigen::Isometry3d later = extrapolated(before, now, share).X_WModule.front();
    EXPECT_NEAR((later.translation() - Eigen::Vector3d(1.2 + 0.2 * share, 2, 2.9 - 0.1 * share)).norm(), 0, 1e-12);
    const double yaw = std::atan2(later(1, 0), later(0, 0));
    EXPECT_NEAR(yaw, 0.5 + 0.2 * share, 1e-12);
  }
}

constexpr double kRate_rad_s = 2.0;

/// The head turns at a constant rate; at tick 5 an object is straight ahead of it.
class TurningPlant : public testing::PlantBase {
 public:
  TurningPlant(Wiring& wiring, const Setup&)
      : scene_(wiring.output(topics::kSceneDescription)), world_(wiring.output(topics::kWorldState)) {}
  void sample(const Tick& tick) override {
    if (tick.index == 0) {
      const auto scene = std::make_unique<msg::SceneDescription>(testing::ScenePlant::description(1));
      scene->module_count = scene->object_count = 1;
      scene->line_point_count = 0;
      scene->camera_noise_sd = 0.0;
      scene_.write(*scene);
    }
    msg::WorldState world{};
    world.module_count = world.object_count = 1;
    const double yaw = kRate_rad_s * (tick.time_s() - 0.1);
    world.module_poses[0] = {{0, 0, 0.035}, {std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)}};
    world.object_poses[0] = {{1.5, 0, 0.075}, {1, 0, 0, 0}};
    world_.write(world);
  }

 private:
  Output<msg::SceneDescription> scene_;
  Output<msg::WorldState> world_;
};

/// The images that the camera writes in the turning world, by tick, with these lines in camera.yaml.
std::map<std::int64_t, std::vector<std::uint8_t>> images_with(const std::string& yaml, std::int64_t ticks,
                                                              std::int64_t restart_at = -1) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  std::ofstream(file) << "error: {" << yaml << "}\n";
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  LocalRun run({testing::member_of_class<TurningPlant>("physics"), make_camera_factory()}, setup, {{"camera", file}});
  std::map<std::int64_t, std::vector<std::uint8_t>> images;
  run.subscribe<msg::CameraImage>(topics::kCameraImage, [&](const msg::CameraImage& image) {
    images[image.exposure_tick] = {image.data._buffer, image.data._buffer + image.data._length};
  });
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    if (tick == restart_at) run.restart("camera");
    run.advance(1);
  }
  return images;
}

/// [pixel²] variance of the column of green light.
double spread(const std::vector<std::uint8_t>& rgb, int width) {
  double sum = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const double light = std::max(0.0, static_cast<double>(rgb[i + 1]) * rgb[i + 1] - 1.0 * rgb[i] * rgb[i]);
    const double u = static_cast<double>(i / 3 % static_cast<std::size_t>(width)) + 0.5;
    sum += light;
    first += light * u;
    second += light * u * u;
  }
  return second / sum - first * first / (sum * sum);
}

TEST(CameraErrors, MotionBlurIsAsWideAsTheWayOfTheImageDuringTheExposure) {
  constexpr double kExposure_s = 0.06;
  const auto sharp = images_with("exposure_s: 0", 11), blurred = images_with("exposure_s: 0.06", 11);
  EXPECT_EQ(sharp.at(0), blurred.at(0));  // before the second tick no velocity is known
  // A point straight ahead at the height of the camera, which is tilted by 0.3 rad: u = f tan(yaw) / cos(tilt).
  const double way = kRate_rad_s * kExposure_s * 160.0 / std::cos(0.3);
  const double expected = way * way / 12.0;
  const double found = spread(blurred.at(5), 320) - spread(sharp.at(5), 320);
  EXPECT_GT(expected, 20.0);
  EXPECT_NEAR(found, expected, 0.08 * expected);
}

TEST(CameraErrors, ARestartedCameraRepeatsItsErrors) {
  const std::string errors = "dropped_share: 0.5, exposure_s: 0.04, blur_pixels: 1.5, red_gain: 1.5";
  const auto whole = images_with(errors, 60);
  EXPECT_GE(whole.size(), 2u);
  EXPECT_LE(whole.size(), 10u);
  for (const std::int64_t at : {1, 23, 31}) EXPECT_EQ(images_with(errors, 60, at), whole) << at;
}

TEST(CameraErrors, RefusesWhatNoCameraDoes) {
  try {
    static_cast<void>(images_with("blur_pixels: -1", 1));
    FAIL();
  } catch (const ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find("error.blur_pixels: found -1, accepted 0 to 20"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace constrictor
