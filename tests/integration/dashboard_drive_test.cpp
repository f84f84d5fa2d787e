// Viewers of the dashboard drive a robot that consists of the real components, and change its parameters.
#include "integration/dashboard_run.hpp"
#include "integration/run_watcher.hpp"

namespace constrictor::testing {
namespace {

class DashboardDrive : public DashboardRun {
 protected:
  /// True when the setpoints have not changed for 60 ticks in a row.
  static bool stands(Watcher& watcher) {
    return eventually(
        [&] {
          watcher.poll();
          return watcher.changed_tick >= 0 && watcher.commands.back().header.tick > watcher.changed_tick + 60;
        },
        20s);
  }
};

TEST_F(DashboardDrive, TheRobotMovesOnlyWhileAViewerRepeatsTheDrive) {
  Viewer viewer(port_);
  Watcher watcher(domain());
  const std::string forwards = R"({"speed_m_s":0.3,"turn_rad_s":0.1})";
  const std::string let_go = R"({"speed_m_s":0,"turn_rad_s":0})";
  EXPECT_EQ(viewer.ask("drive", let_go), "the robot stands already, or is not driven from here");
  ASSERT_EQ(viewer.ask("drive", forwards), "0.30 m/s, 0.10 rad/s");
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  EXPECT_EQ(std::string(watcher.authorities.back().first.source).substr(0, 10), "dashboard.");
  ASSERT_TRUE(watcher.moves());
  ASSERT_TRUE(stands(watcher)) << "no viewer repeats the drive any more";
  EXPECT_EQ(watcher.authorities.back().first.level, msg::kAuthorityOperator) << "the planner must not go on by itself";
  // Repeated for 3 s of the run, which are 1.5 s of wall time: much longer than a single drive lasts.
  const std::int64_t begin = watcher.commands.back().header.tick;
  while (watcher.commands.back().header.tick < begin + 150) {
    ASSERT_EQ(viewer.ask("drive", forwards), "0.30 m/s, 0.10 rad/s");
    watcher.poll();
  }
  EXPECT_GT(watcher.changed_tick, begin + 130) << "it drives still";
  EXPECT_EQ(viewer.ask("drive", let_go), "the robot stands");
  ASSERT_TRUE(stands(watcher));
  EXPECT_EQ(viewer.ask("release", "{}"), "authority released");
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
}

// A stopped drive must not take authority back by itself.
TEST_F(DashboardDrive, ADriveEndsWithAStopAndWithTheDashboard) {
  Viewer driver(port_), stopper(port_);
  Watcher watcher(domain());
  const std::string forwards = R"({"speed_m_s":0.3,"turn_rad_s":0})";
  ASSERT_EQ(driver.ask("drive", forwards), "0.30 m/s, 0.00 rad/s");
  ASSERT_EQ(driver.ask("drive", forwards), "0.30 m/s, 0.00 rad/s");
  EXPECT_EQ(stopper.ask("stop", "{}"), "emergency stop: the robot holds its posture");
  EXPECT_TRUE(eventually([&] { return driver.ask("drive", forwards).starts_with("failure: drive: "); }));
  EXPECT_TRUE(driver.ask("drive", forwards).starts_with("failure: drive: ")) << "the stop is latched";
  EXPECT_EQ(stopper.ask("clear_stop", "{}"), "emergency stop cleared");
  EXPECT_EQ(driver.ask("drive", forwards), "0.30 m/s, 0.00 rad/s") << "a new order, after the stop was cleared";
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  dashboard_->signal(SIGKILL);
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone, 5s)) << "no process asserts that the dashboard is alive";
  EXPECT_TRUE(stands(watcher));
  dashboard_.reset();
}

TEST_F(DashboardDrive, TasksAndParametersAreObeyedOrRefusedWithTheReason) {
  Viewer viewer(port_);
  EXPECT_EQ(viewer.ask("drive", R"({"speed_m_s":3,"turn_rad_s":0})"),
            "failure: drive: accepted {\"speed_m_s\": -2 to 2}");
  EXPECT_EQ(viewer.ask("drive", R"({"speed_m_s":1})"), "failure: drive: accepted {\"turn_rad_s\": -4 to 4}");
  EXPECT_EQ(viewer.ask("task", R"({"task":"dance"})").substr(0, 36), "failure: task: found 'dance', accept");
  EXPECT_NE(viewer.ask("task", R"({"task":"rotate"})").find("rotate needs a direction"), std::string::npos);
  EXPECT_EQ(viewer.ask("task", R"({"task":"rotate direction=left"})"), "rotate was accepted");
  EXPECT_EQ(viewer.ask("stand", "{}"), "the robot stands");
  EXPECT_EQ(viewer.ask("release", "{}"), "authority released");
  Process teleop = start({"teleop", "--drive", "0.2,0"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  const std::string taken = viewer.ask("take", "{}");
  EXPECT_TRUE(taken.starts_with("failure: take: ")) << taken;
  EXPECT_NE(taken.find("teleop"), std::string::npos) << taken;
  teleop.signal(SIGINT);
  ASSERT_EQ(teleop.wait(20s), 130) << teleop.errors();

  const auto value_of = [&](const std::string& name) {
    for (const auto& parameter : nlohmann::json::parse(viewer.ask("param_list", "{}"), nullptr, false)) {
      const auto& pending = parameter.at("pending");
      if (parameter.at("name") == name) return (pending.is_null() ? parameter : pending).at("value").get<double>();
    }
    return -1.0;
  };
  const std::string name = "navigation.travel.speed_m_s";
  const double before = value_of(name);
  ASSERT_GT(before, 0);
  const std::string answer = viewer.ask("param_set", R"({"name":")" + name + R"(","value":0.9})");
  EXPECT_TRUE(answer.starts_with(name + ": 0.9 from tick ")) << answer;
  EXPECT_NE(before, 0.9);
  EXPECT_EQ(value_of(name), 0.9) << "the list shows an accepted change at once";
  // A reader that collects the lists anew for each call takes at least 0.3 s.
  constexpr int kCalls = 20;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kCalls; ++i) EXPECT_EQ(value_of(name), 0.9);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kCalls * 300ms) << "the dashboard knows the lists already";
  const std::string refused = viewer.ask("param_set", R"({"name":")" + name + R"(","value":900})");
  EXPECT_TRUE(refused.starts_with("failure: " + name + ": ")) << refused;
  EXPECT_NE(refused.find("accepted"), std::string::npos) << refused;
  EXPECT_TRUE(viewer.ask("param_set", R"({"name":"navigation.nothing","value":1})").starts_with("failure: "));
  EXPECT_EQ(viewer.ask("param_set", R"({"name":"x","value":null})"),
            "failure: param_set: accepted {\"value\": -1000000000000 to 1000000000000}");
}

}  // namespace
}  // namespace constrictor::testing
