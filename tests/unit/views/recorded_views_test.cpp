// What the views of a recorded run contain, and when.
#include "views/recorded_views.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "recording/message_cdr.hpp"

namespace constrictor::views {
namespace {

using nlohmann::json;

struct Written {
  View view;
  std::uint64_t time_ns;
  std::string data;
};

class RecordedViewsTest : public ::testing::Test {
 protected:
  template <class T>
  void take(const auto& topic, const T& message, std::uint64_t time_ns) {
    const std::string cdr = cdr_of(message);
    views_.take(std::string(topic.name), mcap::bytes_of(cdr), time_ns);
  }
  [[nodiscard]] std::vector<std::uint64_t> times_of(View view) const {
    std::vector<std::uint64_t> times;
    for (const auto& one : written_)
      if (one.view == view) times.push_back(one.time_ns);
    return times;
  }
  [[nodiscard]] json newest(View view) const {
    json found;
    for (const auto& one : written_)
      if (one.view == view) found = json::parse(one.data);
    return found;
  }
  static msg::WorldState world_at(std::int64_t tick) {
    msg::WorldState world{};
    world.header.tick = tick;
    world.module_count = 1;
    world.module_poses[0].orientation.w = 1;
    world.module_poses[0].position_m.z = 0.05;
    return world;
  }

  std::vector<Written> written_;
  RecordedViews views_{[this](View view, std::uint64_t time_ns, std::string_view data) {
    written_.push_back({view, time_ns, std::string(data)});
  }};
};

TEST_F(RecordedViewsTest, TheSceneIsWrittenTwentyTimesASecondAndAgainAfterAReset) {
  for (std::int64_t tick = 0; tick < 6; ++tick)
    take(topics::kWorldState, world_at(tick), static_cast<std::uint64_t>(tick) * 20'000'000);
  EXPECT_EQ(times_of(View::kScene), (std::vector<std::uint64_t>{0, 60'000'000}));
  EXPECT_EQ(times_of(View::kTransforms), times_of(View::kScene));
  msg::WorldState again = world_at(0);
  again.header.epoch = 2;
  take(topics::kWorldState, again, 10'000'000);
  EXPECT_EQ(times_of(View::kScene).back(), 10'000'000u);
}

TEST_F(RecordedViewsTest, AnnotationsKnowWhereTheHeadWasAtTheExposure) {
  msg::CameraInfo lens{};
  lens.width = lens.height = 100;
  lens.fx = lens.fy = 100;
  lens.cx = lens.cy = 50;
  lens.frame_period_s = 0.1;
  lens.X_HC.orientation = {0.5, -0.5, 0.5, -0.5};  // looks ahead: z of C is x of H, x of C is -y of H
  take(topics::kCameraInfo, lens, 1);
  EXPECT_EQ(newest(View::kCalibration).at("K").at(0), 100.0);
  take(topics::kWorldState, world_at(7), 7);
  msg::LinePercept line{};
  line.exposure_tick = 7;
  line.visible = true;
  line.point_count = 2;
  line.x_m[0] = 0.5;
  line.x_m[1] = 1.0;
  line.y_m[1] = -0.2;
  take(topics::kLinePercept, line, 8);
  take(topics::kObjectPercepts, msg::ObjectPercepts{}, 8);
  const json points = newest(View::kAnnotations).at("points").at(0).at("points");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points.at(0).at("x").get<double>(), 50.0, 1e-9);
  EXPECT_NEAR(points.at(0).at("y").get<double>(), 50.0 + 100 * 0.05 / 0.5, 1e-9);
  EXPECT_NEAR(points.at(1).at("x").get<double>(), 50.0 + 100 * 0.2 / 1.0, 1e-9);
  EXPECT_NEAR(points.at(1).at("y").get<double>(), 50.0 + 100 * 0.05 / 1.0, 1e-9);
}

TEST_F(RecordedViewsTest, EventsAndLinesAreOneLogInTheTimeOfTheRecording) {
  msg::TaskEvent event{};
  event.task = msg::kTaskGrasp;
  event.event = msg::kEventObjectGrasped;
  take(topics::kTaskEvent, event, 3'000'000'000);
  EXPECT_EQ(newest(View::kLog).at("message"), "grasp: object_grasped");
  msg::LogLine line{};
  set_text(line.message, "no image");
  set_text(line.component, "camera");
  line.wall_time_ns = 1'700'000'000'000'000'000;
  line.level = msg::kLogWarning;
  take(barrier_topics::kLog, line, 4'000'000'000);
  EXPECT_EQ(newest(View::kLog).at("name"), "camera");
  EXPECT_EQ(newest(View::kLog).at("timestamp").at("sec"), 4);
}

TEST_F(RecordedViewsTest, WhatViolatesTheContractOrIsNeededByNoViewIsLeftOut) {
  msg::WorldState broken = world_at(1);
  broken.module_poses[0].position_m.x = std::numeric_limits<double>::infinity();
  take(topics::kWorldState, broken, 1);
  take(topics::kJointState, msg::JointState{}, 1);
  views_.take(std::string(topics::kWorldState.name), {}, 1);
  views_.take("somebody/else", {}, 1);
  EXPECT_TRUE(written_.empty());
}

}  // namespace
}  // namespace constrictor::views
