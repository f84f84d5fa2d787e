// Which images perception draws: every n-th one, and the first one after an event of a task.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "constrictor/text.hpp"
#include "perception/perception.hpp"
#include "ray_caster.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

using Exposures = std::vector<std::int64_t>;

/// Images of a blue line every 5 ticks, visible 2 ticks after their exposure.
ComponentFactory noisy_eye() {
  return testing::scripted_member("camera",
                                  [](Wiring& wiring) -> testing::StepFunction {
                                    return [infos = wiring.output(topics::kCameraInfo),
                                            images = wiring.output(topics::kCameraImage)](const Tick& tick) {
                                      const msg::CameraInfo info = testing::camera_info(64, 48);
                                      if (tick.index == 0) infos.write(info);
                                      testing::Scene scene;
                                      scene.line = testing::Arc{{-0.2, 0.08}, 0.0, 0.0};
                                      scene.seed = static_cast<std::uint64_t>(tick.index) + 1;
                                      scene.noise_sd = 0.01;
                                      cv::Mat picture = testing::draw(scene, info, {});
                                      msg::CameraImage image{};
                                      image.width = info.width;
                                      image.height = info.height;
                                      image.exposure_tick = tick.index;
                                      image.data._buffer = picture.data;
                                      image.data._length = image.data._maximum = 64 * 48 * 3;
                                      images.write(image);
                                    };
                                  },
                                  {5, 2});
}

/// A run in which events happen at these ticks, each visible one tick later, and `picture_period` is set to 1 at tick
/// 60 and to 3 at tick 90 if `tuned`.
std::unique_ptr<LocalRun> run_with(const std::set<std::int64_t>& events, bool tuned = false,
                                   const std::filesystem::path& config = {}) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  const ComponentFactory body = testing::scripted_plant([](Wiring& wiring) -> testing::StepFunction {
    return [out = wiring.output(topics::kImuState)](const Tick&) {
      msg::ImuState state{};
      state.orientation = testing::orientation({});
      out.write(state);
    };
  });
  const ComponentFactory navigation = testing::scripted_writer<msg::TaskEvent>("navigation", topics::kTaskEvent,
                                                                               [=](const Tick& tick, const auto& out) {
                                                                                 if (events.contains(tick.index))
                                                                                   out.write(msg::TaskEvent{});
                                                                               });
  const ComponentFactory desk = testing::scripted_writer<msg::ParameterChange>(
      "input", topics::kParameterChange, [=](const Tick& tick, const auto& out) {
        if (!tuned || (tick.index != 50 && tick.index != 80)) return;
        msg::ParameterChange change{};
        set_text(change.source, "test");
        set_text(change.name, "perception.picture_period");
        change.value = tick.index == 50 ? 1.0 : 3.0;
        change.effective_tick = tick.index + 10;
        out.write(change);
      });
  return std::make_unique<LocalRun>(
      std::vector<ComponentFactory>{body, noisy_eye(), navigation, desk, make_perception_factory()}, setup,
      std::map<std::string, std::filesystem::path>{{"perception", config}});
}

/// The exposures that are drawn before tick 130, with a restart of perception before each of some ticks.
Exposures drawn_by(LocalRun& run, const std::set<std::int64_t>& restarts = {}) {
  Exposures drawn;
  int lines = 0;
  run.subscribe<msg::CameraImage>(topics::kProcessedImage, [&](const msg::CameraImage& picture) {
    EXPECT_EQ(picture.data._length, 64U * 48U * 3U);
    drawn.push_back(picture.exposure_tick);
  });
  run.subscribe<msg::LinePercept>(topics::kLinePercept, [&](const msg::LinePercept& line) { lines += line.visible; });
  for (std::int64_t tick = 0; tick < 130; ++tick) {
    if (restarts.contains(tick)) run.restart("perception");
    run.advance(1);
  }
  EXPECT_EQ(lines, 26) << "each image has its percepts";
  return drawn;
}

TEST(PictureTurn, EveryFifthImageIsDrawn) { EXPECT_EQ(drawn_by(*run_with({})), (Exposures{0, 25, 50, 75, 100, 125})); }

TEST(PictureTurn, APeriodOfOneDrawsEveryImage) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "perception.yaml") << "picture_period: 1\n";
  EXPECT_EQ(drawn_by(*run_with({}, false, folder.path() / "perception.yaml")).size(), 26U);
}

TEST(PictureTurn, TheFirstImageAfterAnEventIsDrawn) {
  // The image of tick 35 is handled at tick 37. An event of tick 36 is visible then, one of tick 37 is not.
  EXPECT_EQ(drawn_by(*run_with({36})), (Exposures{0, 25, 35, 60, 85, 110}));
  EXPECT_EQ(drawn_by(*run_with({37})), (Exposures{0, 25, 40, 65, 90, 115}));
  EXPECT_EQ(drawn_by(*run_with({36, 37, 38})), (Exposures{0, 25, 35, 40, 65, 90, 115}));
}

TEST(PictureTurn, ThePeriodMayChangeDuringARun) {
  // The image of tick 55 is handled before the change of tick 60, and the one of tick 85 before that of tick 90.
  EXPECT_EQ(drawn_by(*run_with({}, true)), (Exposures{0, 25, 50, 60, 65, 70, 75, 80, 85, 100, 115}));
}

TEST(PictureTurn, ARestartChangesNothing) {
  const std::set<std::int64_t> events{36, 71};
  for (const std::set<std::int64_t>& restarts :
       {std::set<std::int64_t>{1, 26, 36, 37, 38, 39}, {37, 59, 60, 61, 72}, {42, 47, 52, 57, 62, 73, 91}}) {
    auto whole = run_with(events, true), broken = run_with(events, true);
    EXPECT_EQ(drawn_by(*whole), drawn_by(*broken, restarts));
    EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
  }
}

}  // namespace
}  // namespace constrictor
