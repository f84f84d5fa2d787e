// The report on a mission whose every figure is known.
#include "sim/report/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "runtime/local_run.hpp"
#include "runtime/share.hpp"
#include "synthetic_run.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

using nlohmann::json;
using test::Story;
using testing::TemporaryFolder;

struct Told {
  json mission;
  std::map<std::string, std::string> files;
  std::int64_t last_tick = 0;
};

Told tell(const Story& story, const std::vector<std::int64_t>& restarts = {}, const std::string& configuration = {}) {
  const TemporaryFolder folder;
  const TemporaryFolder configurations;
  Setup setup;
  setup.robot_file = share_path("components/robot/mamba.yaml");
  setup.output_dir = folder.path() / "run";
  std::map<std::string, std::filesystem::path> config_files;
  if (!configuration.empty()) {
    report::replace_file(configurations.path() / "report.yaml", configuration);
    config_files["report"] = configurations.path() / "report.yaml";
  }
  auto members = test::story_members(story);
  members.push_back(make_report_factory());
  LocalRun run(members, setup, config_files);
  for (const std::int64_t tick : restarts) {
    run.advance(tick - run.tick());
    run.restart("report");
  }
  run.advance(2000);
  EXPECT_TRUE(run.ended());
  Told told;
  told.files = folder.contents();
  told.last_tick = run.tick();
  if (told.files.count("run/mission.json") > 0) told.mission = json::parse(told.files.at("run/mission.json"));
  return told;
}

TEST(Report, FiguresEqualWhatTheStorySays) {
  const Story story;
  const Told told = tell(story);
  const json& mission = told.mission;
  EXPECT_EQ(mission["success"], true);
  EXPECT_EQ(mission["seed"], 11);
  EXPECT_EQ(mission["scenario"], "story");
  EXPECT_NEAR(mission["line"]["rms_cross_track_m"], story.offset_m, 1e-9);
  EXPECT_NEAR(mission["line"]["max_cross_track_m"], story.offset_m, 1e-9);
  EXPECT_NEAR(mission["line"]["visible_fraction"], 0.75, 0.02);
  EXPECT_NEAR(mission["pose_error"]["rms_m"], std::hypot(story.pose_error_x_m, story.pose_error_y_m), 1e-9);
  EXPECT_NEAR(mission["pose_error"]["rms_rad"], story.yaw_error_rad, 1e-9);
  ASSERT_EQ(mission["objects"].size(), 2U);
  for (const json& object : mission["objects"]) {
    EXPECT_EQ(object["grasped"], true);
    EXPECT_EQ(object["dropped"], true);
    EXPECT_EQ(object["in_zone"], true);
  }
  EXPECT_EQ(mission["objects"][1]["colour"], "red");
  EXPECT_NEAR(mission["objects"][1]["zone_distance_m"], story.red_drop_distance_m, 1e-12);
  EXPECT_EQ(mission["recoveries"], 1);

  ASSERT_EQ(mission["events"].size(), test::scripted_events().size());
  EXPECT_EQ(mission["events"][3]["event"], "object_grasped");
  EXPECT_EQ(mission["events"][3]["task"], "grasp");
  EXPECT_EQ(mission["events"][3]["parameters"]["colour"], "green");
  EXPECT_NEAR(mission["events"][3]["sim_time_s"], 120 * 0.02, 1e-9);
  ASSERT_EQ(mission["states"].size(), 3U);
  EXPECT_EQ(mission["states"][1]["state"], "retrieve_first");
  EXPECT_NEAR(mission["states"][1]["sim_time_s"], 60 * 0.02, 1e-9);

  // The end: seen one tick after it was said, and 2 s for things to settle.
  const std::int64_t last = story.mission_end_tick + 1 + 100;
  EXPECT_EQ(mission["ticks"], last);
  EXPECT_NEAR(mission["sim_time_s"], 0.02 * static_cast<double>(last), 1e-9);
  char byte[3];
  std::snprintf(byte, sizeof byte, "%02x", static_cast<unsigned>(last & 0xFF));
  const std::string hash = mission["state_hash"];
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(hash.substr(0, 2), byte);
  EXPECT_EQ(hash.substr(62), "ab");
}

TEST(Report, KilledAndRestartedItLeavesTheSameFiles) {
  const Told whole = tell({});
  ASSERT_GT(whole.files.size(), 20U);
  // Just after events, amid waits for pictures, after the mission's end, and in the last tick.
  const Told restarted = tell({}, {1, 12, 61, 62, 63, 91, 125, 150, 201, 261, 300, 321, 401, 422, 423, 500, 521});
  EXPECT_EQ(whole.last_tick, restarted.last_tick);
  ASSERT_EQ(whole.files.size(), restarted.files.size());
  for (const auto& [name, bytes] : whole.files) EXPECT_TRUE(restarted.files.at(name) == bytes) << name << " differs";
}

TEST(Report, AnObjectOutsideItsZoneIsNoSuccess) {
  Story story;
  story.red_drop_distance_m = 0.31;
  const json mission = tell(story).mission;
  EXPECT_EQ(mission["success"], false);
  EXPECT_EQ(mission["mission"], "succeeded");  // so the planner thought
  EXPECT_EQ(mission["objects"][0]["in_zone"], true);
  EXPECT_EQ(mission["objects"][1]["in_zone"], false);
}

TEST(Report, TheWrongOrderIsNoSuccess) {
  Story story;
  story.first_colour = msg::kColourRed;
  EXPECT_EQ(tell(story).mission["success"], false);
}

TEST(Report, AnExternalPlannerMayHaveAnOrderOfItsOwn) {
  Story story;
  story.first_colour = msg::kColourRed;
  story.level = msg::kAuthorityExternal;
  EXPECT_EQ(tell(story).mission["success"], true);
}

TEST(Report, EndsAtTheTimeLimit) {
  Story story;
  story.mission_end_tick = 1'000'000;
  const Told told = tell(story, {}, "max_sim_time_s: 9.0\nsettle_s: 2.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n");
  EXPECT_EQ(told.mission["ticks"], 450);
  EXPECT_EQ(told.mission["success"], false);
  EXPECT_EQ(told.mission["mission"], "running");
}

TEST(Report, JournalsTorquesTenTimesASecond) {
  const Told told = tell({});
  const std::string& csv = told.files.at("run/joint_torques.csv");
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.rfind("sim_time_s,joint_0_nm,joint_2_nm", 0), 0U);
  for (int i = 0; std::getline(lines, line); ++i) {
    double time = 0, first = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &time, &first), 2);
    EXPECT_NEAR(time, 0.1 * i, 1e-9);
    EXPECT_NEAR(first, 3.0 * std::sin(2.0 * time) * (5 * i > 120 ? 1.5 : 1.0), 1e-4);
  }
}

TEST(Report, PicturesOfAMomentShowThatMomentOrSoonAfter) {
  const Told told = tell({});
  const auto brightness = [&](const std::string& name) {
    const std::string& bytes = told.files.at("run/snapshots/" + name);
    const cv::Mat image = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
    return static_cast<int>(image.at<cv::Vec3b>(0, 1)[0]);  // tells the tick, see write_picture
  };
  // The event of tick 120 is visible in 121; the newest camera image then is that of 115, visible in 117.
  EXPECT_EQ(brightness("0000120_camera.png"), 115);
  EXPECT_GE(brightness("0000120_processed.png"), 115);
  EXPECT_EQ(brightness("0000120_scene.png"), 150);
}

// The camera is anybody's: what calls itself 64 x 48 pixels and brings ten bytes is not drawn.
TEST(Report, ImagesWithoutTheirPixelsAreLeftOut) {
  test::Story story;
  story.torn_from_tick = 100;
  const Told told = tell(story);
  EXPECT_TRUE(told.files.contains("run/snapshots/0000090_camera.png"));
  for (const std::string name : {"camera", "processed"}) EXPECT_FALSE(told.files.contains("run/snapshots/0000120_" + name + ".png")) << name;
  EXPECT_TRUE(told.files.contains("run/figure.png"));
}

TEST(Report, WithoutAFolderItStillEndsTheRun) {
  constrictor::Setup setup;
  setup.robot_file = share_path("components/robot/mamba.yaml");
  auto members = test::story_members({});
  members.push_back(make_report_factory());
  LocalRun run(members, setup);
  run.advance(2000);
  EXPECT_TRUE(run.ended());
  EXPECT_LT(run.tick(), 600);
}

}  // namespace
}  // namespace constrictor
