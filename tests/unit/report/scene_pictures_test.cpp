// The pictures of the scene that the report draws after the end of a run.
#include "sim/report/scene_pictures.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "constrictor/reflect.hpp"
#include "sim/overview/overview.hpp"
#include "sim/report/report.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
using report::MomentFiles;
using Files = std::map<std::string, std::string>;

/// A run of the scripted mission with a report. It keeps scene and world states of all ticks.
struct StoryRun {
  testing::TemporaryFolder folder;
  msg::SceneDescription scene{};
  std::map<std::int64_t, msg::WorldState> worlds;
  LocalRun run;

  StoryRun() : run(members(), setup(folder.path())) {
    run.subscribe<msg::SceneDescription>(topics::kSceneDescription, [this](const auto& message) { scene = message; });
    run.subscribe<msg::WorldState>(topics::kWorldState,
                                   [this](const auto& message) { worlds[message.header.tick] = message; });
  }
  static Setup setup(const fs::path& output_dir) {
    Setup setup;
    setup.robot_file = data_path("components/lib/robot/mamba.yaml");
    setup.output_dir = output_dir;
    return setup;
  }
  static std::vector<ComponentFactory> members() {
    auto members = testing::story_members({});
    members.push_back(make_report_factory());
    return members;
  }
  /// Goes on to the end of the run; before tick `end_tick`, if a user ends it then.
  Files end(std::int64_t end_tick = -1) {
    if (end_tick >= 0) {
      run.advance(end_tick - run.tick());
      run.end_run();
    }
    run.advance(2000);
    EXPECT_TRUE(run.ended());
    return folder.contents();
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder.path() / "snapshots" / name; }
};

cv::Mat decoded(const std::string& png) {
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

/// The picture that the component `overview` publishes of this world state.
cv::Mat published_picture(const msg::SceneDescription& scene, const msg::WorldState& world) {
  const auto plant = testing::scripted_plant([&](Wiring& wiring) -> testing::StepFunction {
    return [&, scenes = wiring.output(topics::kSceneDescription),
            worlds = wiring.output(topics::kWorldState)](const Tick&) {
      scenes.write(scene);
      worlds.write(world);
    };
  });
  LocalRun run({plant, make_overview_factory()}, StoryRun::setup({}));
  run.advance(1);
  const msg::CameraImage* image = run.latest(topics::kOverviewImage);
  if (image == nullptr) return {};
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(image->height, image->width, CV_8UC3, image->data._buffer), bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

void expect_same(const Files& files, const Files& expected) {
  EXPECT_EQ(files.size(), expected.size());
  for (const auto& [name, bytes] : expected) {
    ASSERT_TRUE(files.contains(name)) << name;
    EXPECT_TRUE(files.at(name) == bytes) << name << " differs";
  }
}

TEST(ScenePictures, EqualThoseOfTheComponentOverviewForTheWorldOfTheMoment) {
  StoryRun story;
  const Files files = story.end();
  // The report receives the event of tick 120 in tick 121, and the end of the mission in the tick of its moment.
  for (const auto& [name, tick] : std::map<std::string, std::int64_t>{{"0000120", 121}, {"0000421", 421}}) {
    const cv::Mat drawn = decoded(files.at("snapshots/" + name + "_scene.png"));
    const cv::Mat published = published_picture(story.scene, story.worlds.at(tick));
    ASSERT_EQ(drawn.size(), published.size()) << name;
    EXPECT_EQ(cv::norm(drawn, published, cv::NORM_INF), 0.0) << name;
    EXPECT_NE(cv::norm(drawn, published_picture(story.scene, story.worlds.at(tick - 10)), cv::NORM_INF), 0.0)
        << "the pictures of different ticks must differ, or this test proves nothing";
  }
}

TEST(ScenePictures, AreDrawnForTheRowsOfTheFigureOnly) {
  const Files files = StoryRun().end();
  for (const std::string tick : {"0000010", "0000060", "0000200", "0000320", "0000421"})
    EXPECT_TRUE(files.contains("snapshots/" + tick + "_scene.png")) << tick;
  std::size_t scenes = 0;
  for (const auto& [name, bytes] : files) {
    scenes += name.ends_with("_scene.png") ? 1 : 0;
    EXPECT_FALSE(name.ends_with(MomentFiles::kWorld)) << name << " is left";
  }
  EXPECT_EQ(scenes, 10U);  // the nine key events, and the end of the mission
}

TEST(ScenePictures, AreDrawnWhenAUserEndsTheRun) {
  StoryRun story;
  const Files files = story.end(250);
  EXPECT_TRUE(files.contains("snapshots/0000120_scene.png"));
  EXPECT_FALSE(files.contains("snapshots/0000260_scene.png"));
  const cv::Mat last = decoded(files.at("snapshots/0000249_scene.png"));
  EXPECT_EQ(cv::norm(last, published_picture(story.scene, story.worlds.at(249)), cv::NORM_INF), 0.0);
}

TEST(ScenePictures, ADamagedOrMissingWorldStateLeavesAnEmptyFrameAndAllOtherPictures) {
  const Files expected = StoryRun().end();
  StoryRun story;
  story.run.advance(410);
  ASSERT_TRUE(report::read_world(story.file("0000120_world.bin")));
  fs::resize_file(story.file("0000060_world.bin"), fs::file_size(story.file("0000060_world.bin")) - 1);
  fs::resize_file(story.file("0000090_world.bin"), 10);
  {
    std::fstream file(story.file("0000120_world.bin"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(300);
    file.put('\x7f');
  }
  fs::remove(story.file("0000200_world.bin"));
  for (const std::string tick : {"0000060", "0000090", "0000120", "0000200"})
    EXPECT_FALSE(report::read_world(story.file(tick + "_world.bin"))) << tick;
  const Files files = story.end();
  const std::set<std::string> without{"snapshots/0000060_scene.png", "snapshots/0000090_scene.png",
                                      "snapshots/0000120_scene.png", "snapshots/0000200_scene.png"};
  for (const auto& [name, bytes] : expected) {
    EXPECT_EQ(files.contains(name), !without.contains(name)) << name;
    if (name == "figure.png" || !files.contains(name)) continue;
    EXPECT_TRUE(files.at(name) == bytes) << name;
  }
  EXPECT_EQ(decoded(files.at("figure.png")).size(), decoded(expected.at("figure.png")).size());
  EXPECT_NE(files.at("figure.png"), expected.at("figure.png"));
}

/// What a report leaves that was killed in its last step: first pictures, then all files, then fewer world states.
enum class Death { kWhileItDraws, kBeforeItRemovesWorlds, kWhileItRemovesWorlds };

class KilledReport : public ::testing::TestWithParam<Death> {
 protected:
  /// Makes the folder of `story`, whose next tick is the last one of the report, look as the killed process left it.
  static void leave(const StoryRun& story, const Files& expected) {
    int scenes = 0;
    for (const auto& [name, bytes] : expected) {
      const bool scene = name.ends_with("_scene.png");
      if (GetParam() == Death::kWhileItDraws && !(scene && ++scenes <= 4)) continue;
      report::replace_file(story.folder.path() / name, bytes);
    }
    if (GetParam() == Death::kWhileItDraws)
      std::ofstream(story.file("0000200_scene.png.part")) << "the part that was written";
    if (GetParam() != Death::kWhileItRemovesWorlds) return;
    for (const std::string tick : {"0000010", "0000120", "0000320"}) fs::remove(story.file(tick + "_world.bin"));
  }
};

TEST_P(KilledReport, LeavesTheSameFilesAfterItsRestartInTheLastStep) {
  const Files expected = StoryRun().end();
  StoryRun story;
  story.run.advance(521);  // the next step is the last one
  ASSERT_TRUE(fs::exists(story.file("0000421_world.bin")));
  leave(story, expected);
  story.run.restart("report");
  expect_same(story.end(), expected);
}

INSTANTIATE_TEST_SUITE_P(Deaths, KilledReport,
                         ::testing::Values(Death::kWhileItDraws, Death::kBeforeItRemovesWorlds,
                                           Death::kWhileItRemovesWorlds));

TEST(ScenePictures, OfAnEarlierRunInTheSameFolderAreNotUsed) {
  StoryRun story;
  report::replace_file(story.file("0000120_scene.png"), "of an earlier run");
  report::replace_file(story.file("0000077_world.bin"), "of an earlier run");
  story.run.advance(130);
  EXPECT_FALSE(fs::exists(story.file("0000120_scene.png")));
  fs::remove(story.file("0000120_world.bin"));
  const Files files = story.end();
  EXPECT_FALSE(files.contains("snapshots/0000120_scene.png"));
  EXPECT_FALSE(files.contains("snapshots/0000077_world.bin"));
}

TEST(WorldFiles, AreReadAsTheyWereWritten) {
  const testing::TemporaryFolder folder;
  msg::WorldState world{};
  world.header.tick = 7;
  world.module_count = 3;
  world.module_poses[2] = {{0.1, -1e-300, 3.0}, {0.5, -0.5, 0.5, -0.5}};
  world.state_hash[31] = 0xAB;
  report::save_world(folder.path() / "deep" / "a.bin", world);
  const auto read = report::read_world(folder.path() / "deep" / "a.bin");
  ASSERT_TRUE(read);
  std::string written_bytes, read_bytes;
  canonical_bytes(world, written_bytes);
  canonical_bytes(*read, read_bytes);
  EXPECT_EQ(written_bytes, read_bytes);
  EXPECT_FALSE(report::read_world(folder.path() / "missing.bin"));
}

}  // namespace
}  // namespace constrictor
