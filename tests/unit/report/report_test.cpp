// The report on a scripted mission of which every figure is known.
#include "sim/report/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "report_of.hpp"

namespace constrictor {
namespace {

using nlohmann::json;
using testing::Outcome;
using testing::report_of;
using testing::Story;
using testing::travel_m;

TEST(Report, FiguresAreThoseOfTheScript) {
  const Story story;
  const Outcome outcome = report_of(story);
  const json& mission = outcome.mission;
  EXPECT_EQ(mission["success"], true);
  EXPECT_EQ(mission["judged_by"], "ground truth");
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

  ASSERT_EQ(mission["events"].size(), testing::scripted_events().size());
  EXPECT_EQ(mission["events"][3]["event"], "object_grasped");
  EXPECT_EQ(mission["events"][3]["task"], "grasp");
  EXPECT_EQ(mission["events"][3]["parameters"]["colour"], "green");
  EXPECT_NEAR(mission["events"][3]["sim_time_s"], 120 * 0.02, 1e-9);
  ASSERT_EQ(mission["states"].size(), 3U);
  EXPECT_EQ(mission["states"][1]["state"], "retrieve_first");
  EXPECT_NEAR(mission["states"][1]["sim_time_s"], 60 * 0.02, 1e-9);

  // The report sees the end of the mission one tick later, and waits 2 s for objects to come to rest.
  const std::int64_t last = story.mission_end_tick + 1 + 100;
  EXPECT_EQ(mission["ticks"], last);
  EXPECT_NEAR(mission["sim_time_s"], 0.02 * static_cast<double>(last), 1e-9);
  EXPECT_NEAR(mission["mission_time_s"], mission["sim_time_s"].get<double>() - 2.0, 1e-9);  // settle_s
  char byte[3];
  std::snprintf(byte, sizeof byte, "%02x", static_cast<unsigned>(last & 0xFF));
  const std::string hash = mission["state_hash"];
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(hash.substr(0, 2), byte);
  EXPECT_EQ(hash.substr(62), "ab");
}

TEST(Report, LeavesTheSameFilesAfterRestarts) {
  const Outcome whole = report_of({});
  ASSERT_GT(whole.files.size(), 20U);
  for (const auto& [name, bytes] : whole.files) EXPECT_FALSE(name.ends_with(".bin")) << name << " is left";
  // Restarts just after events, while pictures are missing, after the end of the mission, and in the last tick.
  const Outcome restarted =
      report_of({}, {1, 12, 61, 62, 63, 91, 125, 150, 201, 261, 300, 321, 401, 422, 423, 500, 521});
  EXPECT_EQ(whole.last_tick, restarted.last_tick);
  ASSERT_EQ(whole.files.size(), restarted.files.size());
  for (const auto& [name, bytes] : whole.files) EXPECT_TRUE(restarted.files.at(name) == bytes) << name << " differs";
}

TEST(Report, DoesNotSucceedWithAnObjectOutsideItsZone) {
  Story story;
  story.red_drop_distance_m = 0.31;
  const json mission = report_of(story).mission;
  EXPECT_EQ(mission["success"], false);
  EXPECT_EQ(mission["mission"], "failed");
  EXPECT_EQ(mission["reason"],
            "red was believed delivered, but lies 0.31 m from the centre of its zone (radius 0.30 m)");
  EXPECT_EQ(mission["mission"], "failed");
  EXPECT_EQ(mission["believed"], "succeeded");
  EXPECT_EQ(mission["objects"][0]["in_zone"], true);
  EXPECT_EQ(mission["objects"][1]["in_zone"], false);
}

TEST(Report, DoesNotSucceedInTheWrongOrder) {
  Story story;
  story.first_colour = msg::kColourRed;
  const json mission = report_of(story).mission;
  EXPECT_EQ(mission["success"], false);
  EXPECT_EQ(mission["reason"], "red was dropped out of order");
}

TEST(Report, AnotherLookAtADeliveredObjectIsNoAttempt) {
  Story story;
  story.looks_again_tick = 401;
  EXPECT_EQ(report_of(story).mission["success"], true);
}

TEST(Report, AcceptsAnotherOrderOfAnExternalPlanner) {
  Story story;
  story.first_colour = msg::kColourRed;
  story.level = msg::kAuthorityExternal;
  EXPECT_EQ(report_of(story).mission["success"], true);
}

TEST(Report, WritesEverythingWhenAUserEndsTheRun) {
  const Outcome outcome = report_of({}, {}, {}, {.end_tick = 300});
  EXPECT_EQ(outcome.mission["success"], false);
  EXPECT_EQ(outcome.mission["mission"], "unfinished");
  EXPECT_EQ(outcome.mission["reason"], "ended by user at 6.0 s");
  EXPECT_EQ(outcome.mission["objects"].size(), 2U);
  EXPECT_EQ(outcome.mission["objects"][0]["in_zone"], true);
  EXPECT_EQ(outcome.mission["events"].size(), 8U);
  EXPECT_TRUE(outcome.mission["line"]["rms_cross_track_m"].is_number());
  EXPECT_TRUE(outcome.files.contains("run/figure.png"));
  for (const std::string picture : {"camera", "processed", "scene"})
    EXPECT_TRUE(outcome.files.contains("run/snapshots/0000300_" + picture + ".png")) << picture;
}

TEST(Report, NamesThePlannersReason) {
  Story story;
  story.mission_end = msg::kMissionFailed;
  const json mission = report_of(story).mission;
  EXPECT_EQ(mission["mission"], "failed");
  EXPECT_EQ(mission["reason"], "the planner gave up: more than 60 recoveries");
}

TEST(Report, KnowsAMissionThatThePlannerDidNotSeeSucceed) {
  const auto all_in_zones = [](const Story& story, const std::string& mission) {
    return report_of(story, {}, {}, {}, mission).mission["all_in_zones"];
  };
  const std::string both = "{sequence: [green, red], line_colour: blue}";
  Story story;
  story.mission_end = msg::kMissionFailed;
  EXPECT_EQ(all_in_zones(story, both), true);
  EXPECT_EQ(report_of(story, {}, {}, {}, both).mission["demanded"], json({"green", "red"}));
  EXPECT_EQ(all_in_zones(story, "{sequence: [green, green], line_colour: blue}"), false) << "there is one green object";
  EXPECT_EQ(all_in_zones(story, "{sequence: [], line_colour: blue}"), json());
  story.red_drop_distance_m = 0.31;
  EXPECT_EQ(all_in_zones(story, both), false);
  EXPECT_EQ(all_in_zones(story, "{sequence: [green], line_colour: blue}"), true) << "the red one is not demanded";
  story.truth = false;
  EXPECT_EQ(all_in_zones(story, both), json());
}

TEST(Report, AMissionWithoutObjectsSucceedsAtTheEndOfTheLineOnly) {
  Story story;
  story.objects_in_mission = 0;
  story.line_length_m = travel_m(story.mission_end_tick + 101);
  EXPECT_EQ(report_of(story).mission["reason"], "");
  EXPECT_EQ(report_of(story).mission["success"], true);
  story.line_length_m += 1.0;
  EXPECT_EQ(report_of(story).mission["success"], false);
  EXPECT_EQ(report_of(story).mission["reason"], "the head is 1.00 m from the end of the line");
}

TEST(Report, JournalsTorquesTenTimesASecond) {
  const Outcome outcome = report_of({});
  const std::string& csv = outcome.files.at("run/joint_torques.csv");
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

TEST(Report, PicturesShowTheirMoment) {
  const Outcome outcome = report_of({});
  const auto brightness = [&](const std::string& name) {
    const std::string& bytes = outcome.files.at("run/snapshots/" + name);
    const cv::Mat image = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
    return static_cast<int>(image.at<cv::Vec3b>(0, 1)[0]);  // the brightness is the tick, see write_picture
  };
  // The event of tick 120 is visible in tick 121. The newest camera image at that time was exposed in tick 115.
  EXPECT_EQ(brightness("0000120_camera.png"), 115);
  EXPECT_EQ(brightness("0000120_processed.png"), 115) << "it must belong to the same image";
}

// An image of 64 x 48 pixels with ten bytes, as a faulty camera may send it, is not drawn.
TEST(Report, LeavesOutImagesWithMissingPixels) {
  testing::Story story;
  story.torn_from_tick = 100;
  const Outcome outcome = report_of(story);
  EXPECT_TRUE(outcome.files.contains("run/snapshots/0000090_camera.png"));
  for (const std::string name : {"camera", "processed"})
    EXPECT_FALSE(outcome.files.contains("run/snapshots/0000120_" + name + ".png")) << name;
  EXPECT_TRUE(outcome.files.contains("run/figure.png"));
}

TEST(Report, EndsTheRunWithoutAnOutputFolder) {
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  auto members = testing::story_members({});
  members.push_back(make_report_factory());
  LocalRun run(members, setup);
  run.advance(2000);
  EXPECT_TRUE(run.ended());
  EXPECT_LT(run.tick(), 600);
}

TEST(Report, WithoutGroundTruthTellsWhatTheRobotBelieves) {
  Story story;
  story.truth = false;
  const Outcome outcome = report_of(story, {100, 321});
  const json& mission = outcome.mission;
  EXPECT_EQ(mission["success"], true);
  EXPECT_EQ(mission["judged_by"], "the robot");
  EXPECT_EQ(mission["believed"], "succeeded");
  EXPECT_EQ(mission["scenario"], "blind_story");
  EXPECT_EQ(mission["seed"], 12);
  const json green = {
      {"colour", "green"}, {"grasped", true}, {"dropped", true}, {"in_zone", nullptr}, {"zone_distance_m", nullptr}};
  ASSERT_EQ(mission["objects"].size(), 2U);
  EXPECT_EQ(mission["objects"][0], green);
  EXPECT_EQ(mission["objects"][1]["colour"], "red");
  for (const auto& unknown :
       {mission["state_hash"], mission["line"]["rms_cross_track_m"], mission["pose_error"]["rms_m"],
        mission["effort"]["distance_m"], mission["effort"]["cost_of_transport"]})
    EXPECT_TRUE(unknown.is_null()) << unknown;
  EXPECT_NEAR(mission["line"]["visible_fraction"], 0.75, 0.02);
  EXPECT_EQ(mission["events"].size(), testing::scripted_events().size());
  EXPECT_EQ(outcome.files.count("run/figure.png"), 1U);
  EXPECT_GT(
      outcome.files.count("run/snapshots/0000121_camera.png") + outcome.files.count("run/snapshots/0000120_camera.png"),
      0U);
  for (const auto& [name, content] : outcome.files) EXPECT_EQ(name.find("_scene"), std::string::npos) << name;
}

TEST(Report, WithoutGroundTruthAMissionThatFailedHasFailed) {
  Story story;
  story.truth = false;
  story.mission_end = msg::kMissionFailed;
  const Outcome outcome = report_of(story);
  EXPECT_EQ(outcome.mission["success"], false);
  EXPECT_EQ(outcome.mission["reason"], "the planner gave up: more than 60 recoveries");
}

}  // namespace
}  // namespace constrictor
