// The bridge between a real run and another vendor's DDS, which uses only ROS 2's topic and type names.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "client/request_writer.hpp"
#include "client/run_registry.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"
#include "running.hpp"
#include "support/eventually.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

struct Line {
  std::string kind;
  std::vector<std::string> words;
};

std::vector<Line> lines_of(const std::string& output) {
  std::vector<Line> lines;
  std::istringstream stream(output);
  for (std::string text; std::getline(stream, text);) {
    std::istringstream words(text);
    Line line;
    words >> line.kind;
    for (std::string word; words >> word;) line.words.push_back(word);
    lines.push_back(std::move(line));
  }
  return lines;
}

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
  {
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

  std::map<std::string, int> count;
  int compared = 0;
  long long last_ns = -1;
  std::set<std::string> image_stamps, info_stamps;
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
    } else if (line.kind == "imu") {
      EXPECT_EQ(line.words.at(1), "base_link");
      EXPECT_NEAR(std::stod(line.words.at(2)), 9.81, 8.0);  // at rest +g upwards; contacts shake it
    }
  }
  for (const char* kind : {"clock", "joint_states", "imu", "odom", "tf"}) EXPECT_GT(count[kind], 50) << kind;
  EXPECT_GE(count["tf_static"], 1);
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
  Process launcher = run("driven", "line", {"--pace", "1x"});
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  const std::string ros_domain = std::to_string(100 + domain);
  Process bridge({program("ros_bridge"), "--domain", std::to_string(domain), "--ros-domain", ros_domain},
                 {{"ROS_LOCALHOST_ONLY", "1"}});
  const dds::Domain here(domain);
  const auto authorities = dds::Reader<msg::Authority>::member(here.participant(), "authority");
  const auto trajectories = dds::Reader<msg::DesiredTrajectory>::observer(here.participant(), "desired_trajectory");
  dds::WaitSet wait_set(here.participant());
  wait_set.attach(authorities.get());
  wait_set.attach(trajectories.get());
  msg::Authority authority{};
  msg::DesiredTrajectory desired{};
  const auto until = [&](auto condition, std::chrono::seconds bound) {
    for (const auto end = std::chrono::steady_clock::now() + bound; !condition();) {
      if (std::chrono::steady_clock::now() > end) return false;
      wait_set.wait(50ms);
      authorities.take([&](const msg::Authority& now) { authority = now; });
      trajectories.take([&](const msg::DesiredTrajectory& now) { desired = now; });
    }
    return true;
  };
  ASSERT_TRUE(until([&] { return authority.level == msg::kAuthorityPlanner; }, 60s));
  // An operator has authority: the constant velocity is refused. It is obeyed when the operator releases authority.
  const dds::RequestWriter hand(here.participant(), 0);
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
  EXPECT_TRUE(until([&] { return std::abs(desired.frequency_hz + 0.5) < 1e-9; }, 30s))
      << desired.method << " " << desired.frequency_hz;
  EXPECT_NEAR(desired.curvature_1_m, 0.2 / -0.45, 1e-9);
  probe.signal(SIGTERM);
  ASSERT_EQ(probe.wait(20s), 0);
  EXPECT_TRUE(until([&] { return authority.level == msg::kAuthorityPlanner; }, 60s))
      << "level " << int{authority.level};
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(15s));
}

}  // namespace
}  // namespace constrictor::testing
