// The bridge between a real run and another vendor's DDS, which uses only ROS 2's topic and type names.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <map>
#include <set>
#include <thread>

#include "client/request_writer.hpp"
#include "client/run_registry.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"
#include "foreign_clock.h"
#include "probe_lines.hpp"
#include "running.hpp"
#include "support/eventually.hpp"

template <>
const dds_topic_descriptor_t& constrictor::dds::descriptor<rosgraph_msgs_msg_dds__Clock_>() {
  return rosgraph_msgs_msg_dds__Clock__desc;
}

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

TEST_F(RosBridge, RosReceivesTheRobotsTopicsAndTheRunIsTheSameWithoutTheBridge) {
  Process launcher = run("bridged", "short", {"--max-sim-time", "8", "--pace", "2x"});
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  const std::string ros_domain = std::to_string(100 + domain);  // runs take 1 to 100
  Process bridge({program("ros_bridge"), "--domain", std::to_string(domain), "--ros-domain", ros_domain},
                 {{"ROS_LOCALHOST_ONLY", "1"}});
  Process probe({program("ros_probe"), "--domain", ros_domain, "--for", "8"});

  // The robot's own messages, for comparison.
  std::map<std::int64_t, std::vector<double>> said;
  int foreign_clocks = 0;
  {
    const dds::Domain there(100 + domain);
    const auto clocks = dds::Reader<rosgraph_msgs_msg_dds__Clock_>::observer(there.participant(), "rt/clock", 8);
    const dds::Domain here(domain);
    const auto joints = dds::Reader<msg::JointState>::member(here.participant(), "joint_state");
    const auto ticks = dds::Reader<msg::Tick>::member(here.participant(), "barrier/tick");
    dds::WaitSet wait_set(here.participant());
    wait_set.attach(joints.get());
    wait_set.attach(ticks.get());
    bool over = false;
    EXPECT_TRUE(eventually(
        [&] {
          wait_set.wait(200ms);
          clocks.take([&](const auto&) { ++foreign_clocks; });
          joints.take([&](const msg::JointState& m) {
            said[m.header.time_ns].assign(m.position_rad, m.position_rad + m.joint_count);
          });
          ticks.take([&](const msg::Tick& tick) { over = over || tick.final_tick; });
          return over;
        },
        30s));
  }
  ASSERT_TRUE(launcher.wait(30s));
  EXPECT_EQ(bridge.wait(15s), 0) << bridge.errors();  // it ends with the run
  EXPECT_EQ(probe.wait(15s), 0) << probe.errors();

  EXPECT_GT(foreign_clocks, 5) << "a reader with type information of its own must match";
  expect_node(lines_of(probe.output()), bridge.output());

  std::map<std::string, int> count;
  std::set<std::string> healthy, drawn;
  std::size_t line_points = 0;
  int compared = 0;
  long long last_ns = -1;
  std::set<std::string> image_stamps, percept_stamps, info_stamps;
  for (const Line& line : lines_of(probe.output())) {
    ++count[line.kind];
    if (line.kind == "clock") {
      EXPECT_GT(std::stoll(line.words.at(0)), last_ns);
      last_ns = std::stoll(line.words.at(0));
      EXPECT_EQ(last_ns % 20'000'000, 0);
    } else if (line.kind == "joint_states") {
      ASSERT_EQ(line.words.size(), 24u);
      const auto same = said.find(std::stoll(line.words[0]));
      if (same == said.end()) continue;
      for (std::size_t i = 0; i < 23; ++i) {
        char expected[64];
        std::snprintf(expected, sizeof expected, "joint_%02zu=%.17g", i, same->second.at(i));
        EXPECT_EQ(line.words[i + 1], expected);
      }
      ++compared;
    } else if (line.kind == "tf") {
      ASSERT_EQ(line.words.size(), 24u);
      EXPECT_EQ(line.words[0], "odom>base_link");
      EXPECT_EQ(line.words[23], "module_22>module_23");
    } else if (line.kind == "image") {
      EXPECT_EQ(line.words.at(1), "320x240");
      EXPECT_EQ(line.words.at(2), "rgb8");
      EXPECT_EQ(line.words.at(3), "230400");
      EXPECT_GT(std::stol(line.words.at(4)), 230400 * 5) << "a black picture";
      image_stamps.insert(line.words.at(0));
    } else if (line.kind == "camera_info") {
      EXPECT_EQ(line.words.at(2), "plumb_bob");
      info_stamps.insert(line.words.at(0));
    } else if (line.kind == "percept_image") {
      EXPECT_EQ(line.words.at(1), "320x240");
      percept_stamps.insert(line.words.at(0));
    } else if (line.kind == "diagnostics") {
      healthy.insert(line.words.at(0) + " " + line.words.at(2));
    } else if (line.kind.rfind("markers/", 0) == 0) {
      EXPECT_EQ(line.words.at(1), ":0:0:0") << "it begins by deleting the old markers";
      for (std::size_t i = 2; i < line.words.size(); ++i)
        drawn.insert(line.words[i].substr(0, line.words[i].find(':')));
    } else if (line.kind == "line") {
      EXPECT_EQ(line.words.at(0), "odom");
      line_points = std::max<std::size_t>(line_points, std::stoul(line.words.at(1)));
    } else if (line.kind == "imu") {
      EXPECT_EQ(line.words.at(1), "base_link");
      EXPECT_NEAR(std::stod(line.words.at(2)), 9.81, 8.0);  // at rest +g upwards; contacts shake it
    }
  }
  for (const char* kind : {"clock", "joint_states", "imu", "odom", "tf"}) EXPECT_GT(count[kind], 50) << kind;
  EXPECT_GE(count["tf_static"], 1);
  Process urdf({program("constrictor"), "robot", "export", "--urdf"});
  EXPECT_EQ(urdf.wait(20s), 0);
  EXPECT_NE(probe.output().find("\n" + urdf.output()), std::string::npos) << "robot_description";
  // Both kinds are stamped with the exposure, although the processed image comes later.
  EXPECT_GT(std::count_if(percept_stamps.begin(), percept_stamps.end(),
                          [&](const auto& stamp) { return image_stamps.contains(stamp); }),
            5);
  EXPECT_GT(count["rosout"], 5) << "each process logs at its start";
  EXPECT_GT(count["task/status"], 1);
  EXPECT_GT(count["task/event"], 1);
  EXPECT_GT(line_points, 5u);
  for (const char* name : {"line", "objects", "numbers", "line_in_view", "objects_in_view"})
    EXPECT_TRUE(drawn.contains(name)) << name;
  for (const char* name : {"physics", "camera", "perception", "guidance", "navigation", "control", "input", "planner",
                           "report", "run", "ros_bridge"}) {
    EXPECT_TRUE(healthy.contains(std::string("0 ") + name) || healthy.contains(std::string("1 ") + name)) << name;
  }
  EXPECT_GT(count["image"], 5);
  EXPECT_GT(compared, 50);
  for (const auto& stamp : image_stamps)
    EXPECT_TRUE(info_stamps.contains(stamp)) << "no camera_info with the image of " << stamp;

  Process alone = run("alone", "short", {"--max-sim-time", "8", "--in-process"});
  ASSERT_TRUE(alone.wait(60s));
  Process diff({program("constrictor"), "diff", (dir_ / "bridged").string(), (dir_ / "alone").string()});
  EXPECT_EQ(diff.wait(20s), 0) << diff.output();
  EXPECT_EQ(diff.output(), "equal\n");  // every message of every member, the state hash among them
}

TEST_F(RosBridge, AVelocityFromRosTakesAuthorityAndItsWritersEndReleasesIt) {
  Process launcher = run("driven", "case_study", {"--pace", "1x"});
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  const std::string ros_domain = std::to_string(100 + domain);
  Process bridge({program("ros_bridge"), "--domain", std::to_string(domain), "--ros-domain", ros_domain},
                 {{"ROS_LOCALHOST_ONLY", "1"}});
  const dds::Domain here(domain);
  const auto authorities = dds::Reader<msg::Authority>::member(here.participant(), "authority");
  const auto trajectories = dds::Reader<msg::DesiredTrajectory>::observer(here.participant(), "desired_trajectory");
  msg::Authority authority{};
  msg::DesiredTrajectory desired{};
  const auto until = [&](auto condition, std::chrono::seconds bound) {
    return eventually(
        [&] {
          authorities.take([&](const msg::Authority& now) { authority = now; });
          trajectories.take([&](const msg::DesiredTrajectory& now) { desired = now; });
          return condition();
        },
        bound);
  };
  ASSERT_TRUE(until([&] { return authority.level == msg::kAuthorityPlanner; }, 60s));
  // An operator has authority: the constant velocity is refused. It is obeyed when the operator releases authority.
  const RequestWriter hand(here.participant(), 0);
  msg::Request wish{};
  wish.robot_id = 1;
  dds::set_text(wish.source, "hand");
  dds::set_text(wish.token, run_key(domain).token);
  wish.level = msg::kAuthorityOperator;
  wish.kind = msg::kRequestTake;
  wish.header.sequence_number = 1;
  ASSERT_TRUE(until([&] { return hand.heard(); }, 20s));
  hand.write(wish);
  ASSERT_TRUE(until([&] { return std::string(authority.source) == "hand"; }, 20s));
  Process probe({program("ros_probe"), "--domain", ros_domain, "--for", "150", "--drive", "-0.45,0.2"});
  const auto of_bridge = [](const std::string& source) { return source.rfind("ros_bridge.", 0) == 0; };
  ASSERT_TRUE(until([&] { return of_bridge(authority.refused_source); }, 60s)) << bridge.errors();
  EXPECT_EQ(std::string(authority.source), "hand");
  wish.kind = msg::kRequestRelease;
  wish.header.sequence_number = 2;
  hand.write(wish);
  ASSERT_TRUE(until([&] { return authority.level == msg::kAuthorityOperator && of_bridge(authority.source); }, 60s));
  // Backwards at 0.45 m/s with 0.9 m a wave; turning left backwards is a curvature to the right.
  EXPECT_TRUE(until([&] { return std::abs(desired.speed_m_s + 0.45) < 1e-9; }, 30s))
      << desired.motion << " " << desired.speed_m_s;
  EXPECT_NEAR(desired.points[0].curvature_1_m, 0.2 / -0.45, 1e-9);
  probe.signal(SIGTERM);
  ASSERT_EQ(probe.wait(20s), 0);
  EXPECT_TRUE(until([&] { return authority.level == msg::kAuthorityPlanner; }, 60s))
      << "level " << int{authority.level};

  // The same run obeys tasks of ROS programs, refuses what is not a task, and stops.
  const auto ros = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {program("ros_probe"), "--domain", ros_domain, "--for", "60"});
    return Process(std::move(more));
  };
  {
    Process wrong = ros({"--task", "dance"});
    EXPECT_TRUE(wrong.wait_for(R"("request":"dance","state":"refused")", 30s)) << wrong.output();
    EXPECT_TRUE(wrong.wait_for("diagnostics 1 constrictor: ros_bridge refused a request: task: found 'dance'", 30s))
        << "the refusal is counted, with its reason";
    wrong.signal(SIGTERM);
    EXPECT_EQ(wrong.wait(20s), 0);
  }
  {
    Process right = ros({"--task", "rotate direction=left timeout_s=1"});
    EXPECT_TRUE(until([&] { return of_bridge(authority.source); }, 60s));
    EXPECT_TRUE(right.wait_for(R"(timeout_s=1","state":"succeeded")", 60s)) << right.output();
    right.signal(SIGTERM);
    EXPECT_EQ(right.wait(20s), 0);
  }
  EXPECT_TRUE(until([&] { return authority.level == msg::kAuthorityPlanner; }, 60s))
      << "with the end of the task and of its writer, the planner goes on";
  Process stop = ros({"--stop"});
  EXPECT_TRUE(until([&] { return authority.emergency_stop; }, 30s));
  EXPECT_TRUE(stop.wait_for("stopped true", 30s)) << stop.output();
  stop.signal(SIGTERM);
  EXPECT_EQ(stop.wait(20s), 0);
  Process clear = ros({"--clear"});
  EXPECT_TRUE(until([&] { return !authority.emergency_stop; }, 30s));
  EXPECT_TRUE(clear.wait_for("stopped false", 30s)) << clear.output();
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(15s));
}

TEST_F(RosBridge, HumbleSeesTheNodeByItsLongerIds) {
  Process launcher = run("humble", "line", {"--pace", "1x", "--in-process"});
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  const std::string ros_domain = std::to_string(100 + domain);
  Process bridge({program("ros_bridge"), "--run", std::to_string(domain), "--ros-domain", ros_domain},
                 {{"ROS_LOCALHOST_ONLY", "1"}, {"ROS_DISTRO", "humble"}});
  Process probe({program("ros_probe"), "--domain", ros_domain, "--for", "60", "--humble"});
  EXPECT_TRUE(probe.wait_for(" / ros_bridge\n", 60s)) << probe.output() << bridge.errors();
  for (const Line& line : lines_of(probe.output())) {
    if (line.kind != "node") continue;
    EXPECT_EQ(line.words.at(0).substr(32), std::string(16, '0')) << "16 bytes, then zeros";
  }
  bridge.signal(SIGINT);
  EXPECT_EQ(bridge.wait(15s), 0) << bridge.errors();
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(15s));
}

}  // namespace
}  // namespace constrictor::testing
