// Absurd velocities and lines of ROS programs, and absurd statuses of components: requests to the robot are valid and
// within the drive's limits, an emergency stop blocks them, refusals are printable, and diagnostics stay bounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "constrictor/messages.hpp"
#include "constrictor/reflect.hpp"
#include "constrictor/text.hpp"
#include "hostile_filler.hpp"
#include "ros_bridge/ros_diagnostics.hpp"
#include "ros_bridge/ros_translator.hpp"
#include "ros_bridge/task_desk.hpp"
#include "ros_bridge/velocity_pilot.hpp"

namespace constrictor::testing {
namespace {

/// A line of random words, signs and bytes, of which many are a task.
std::string hostile_line(HostileFiller& filler) {
  static const char* const kWords[] = {
      "follow_line", "rotate", "follow_path",   "grasp",     "cancel", "take",    "line_colour", "blue",
      "direction",   "left",   "path",          "timeout_s", "5",      "1e308",   "nan",         "-0",
      "0,0",         "1,inf",  "object_handle", "99999",     "%n%s",   "\x1b[2J", "\xff",        ""};
  static const char* const kBetween[] = {" ", "=", ";", ",", "", "  "};
  std::string line;
  for (std::uint64_t words = filler.roll(12); words > 0; --words) {
    line += kWords[filler.roll(std::size(kWords))];
    line += kBetween[filler.roll(std::size(kBetween))];
  }
  if (filler.roll(200) == 0) line.append(filler.roll(100'000), 'x');
  if (filler.roll(20) == 0) line = "rotate direction=left timeout_s=" + std::to_string(filler.roll(4000));
  return line;
}

TEST(HostileRosBridge, TaskLinesAreValidRequestsOrRefusedWithAPrintableReason) {
  HostileFiller filler(kSeed);
  ros_bridge::TaskDesk desk;
  std::uint64_t requests = 0;
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    const std::string line = hostile_line(filler);
    SCOPED_TRACE(line.substr(0, 200));
    const auto parsed = ros_bridge::parse_task_line(line);
    if (const auto* what = std::get_if<ros_bridge::TaskLine>(&parsed)) {
      ++requests;
      msg::Request request = what->request;
      request.level = msg::kAuthorityOperator;
      ASSERT_EQ(validate(request), std::nullopt);
      continue;
    }
    desk.refuse(line, std::get<std::string>(parsed));
    const auto answers = desk.answers();
    ASSERT_EQ(answers.size(), 1u);
    ASSERT_LT(answers[0].size(), 3000u);
    ASSERT_TRUE(std::all_of(answers[0].begin(), answers[0].end(), [](char c) { return c >= ' ' && c <= '~'; }));
  }
  std::printf("task lines: %llu of %llu are requests\n", static_cast<unsigned long long>(requests),
              static_cast<unsigned long long>(kMessages));
  EXPECT_GT(requests, kMessages / 100);
  EXPECT_EQ(desk.refused(), kMessages - requests);
}

TEST(HostileRosBridge, DiagnosticsOfAbsurdStatusesStayBounded) {
  HostileFiller filler(kSeed);
  ros_bridge::Health health("mamba");
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    filler.begin_message();
    msg::ComponentStatus status{};
    Description<msg::ComponentStatus>::visit(status, filler);
    health.take(status);
    // A report lists all members, and costs as much as taking many messages.
    if (i >= 2000 && i % 50 != 0) continue;
    const auto report = health.report({});
    ASSERT_LE(report.status._length, msg::kMaxMembers + 2) << "a stranger must not fill the memory";
    for (std::uint32_t k = 0; k < report.status._length; ++k) {
      const auto& one = report.status._buffer[k];
      ASSERT_LE(one.level, 3);
      for (const std::string text : {one.name, one.message}) ASSERT_EQ(printable(text), text);
    }
  }
}

TEST(HostileRosBridge, RequestsAreWithinTheDrivesLimitsAndBlockedByAnEmergencyStop) {
  constexpr double kAbsurd[] = {0.0,
                                -0.0,
                                1e308,
                                -1e308,
                                5e-324,
                                0.3,
                                -0.4,
                                1.0,
                                std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()};
  constexpr double kHoldAfter_s = 0.5;
  const ros_bridge::DriveConfig limits;
  ros_bridge::VelocityPilot pilot(kHoldAfter_s);
  HostileFiller filler(kSeed);
  double now_s = 1000.0;
  double heard_s = -1e9;  // of the last velocity
  bool stopped = false;   // an emergency stop came, and since then the velocity was neither zero nor absent
  std::uint64_t motions = 0, releases = 0, blocked = 0;
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << " message " << i);
    now_s += filler.roll(50) == 0 ? 1.0 : 0.02;
    if (now_s - heard_s > kHoldAfter_s) stopped = false;
    if (filler.roll(3) != 0) {
      ros_bridge::Twist twist{};
      for (double* value :
           {&twist.linear.x, &twist.linear.y, &twist.linear.z, &twist.angular.x, &twist.angular.y, &twist.angular.z}) {
        *value = kAbsurd[filler.roll(std::size(kAbsurd))];
      }
      const ros_bridge::Drive drive = ros_bridge::drive_of(twist, limits);
      if (drive == ros_bridge::Drive{}) stopped = false;
      pilot.command(drive, now_s);
      heard_s = now_s;
    }
    if (filler.roll(20) == 0) pilot.answered(filler.roll(2) == 0);
    if (filler.roll(20) == 0) {
      const bool stop = filler.roll(8) == 0;
      pilot.authority(filler.roll(2) == 0, stop, now_s);
      stopped = stopped || stop;
    }
    const auto ask = pilot.next(filler.roll(4) != 0, filler.roll(8) != 0, now_s);
    if (!ask) {
      blocked += stopped;
      continue;
    }
    (ask->kind == msg::kRequestMotion ? motions : releases) += 1;
    ASSERT_TRUE(ask->kind == msg::kRequestMotion || ask->kind == msg::kRequestRelease);
    ASSERT_TRUE(std::abs(ask->drive.speed_m_s) <= limits.max_speed_m_s) << ask->drive.speed_m_s;
    ASSERT_TRUE(std::abs(ask->drive.curvature_1_m) <= limits.max_curvature_1_m) << ask->drive.curvature_1_m;
    ASSERT_TRUE(!stopped || ask->drive == ros_bridge::Drive{})
        << "motion after an emergency stop, without a pause of the velocity";
  }
  std::printf("velocity pilot: %llu motions and %llu releases requested, %llu times blocked\n",
              static_cast<unsigned long long>(motions), static_cast<unsigned long long>(releases),
              static_cast<unsigned long long>(blocked));
  EXPECT_GT(motions, kMessages / 100);
  EXPECT_GT(releases, 0u);
  EXPECT_GT(blocked, 0u);
}

}  // namespace
}  // namespace constrictor::testing
