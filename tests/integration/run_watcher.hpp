// An observer that keeps every message of a run about authority, commands and joints, and functions that evaluate how
// the joints moved.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"

namespace constrictor::testing {

using Clock = std::chrono::steady_clock;

inline constexpr double kMaxSpeed_rad_s = 4.0;  // of Mamba's joints (components/lib/robot/mamba.yaml)
inline constexpr double kTick_s = 0.02;

class Watcher {
 public:
  explicit Watcher(std::uint32_t domain)
      : domain_(domain),
        authority_(reader<msg::Authority>(topics::kAuthority)),
        command_(reader<msg::JointCommand>(topics::kJointCommand)),
        joints_(reader<msg::JointState>(topics::kJointState)),
        mission_(reader<msg::MissionStatus>(topics::kMissionStatus)),
        task_(reader<msg::TaskStatus>(topics::kTaskStatus)) {}
  void poll() {
    authority_.take([this](const msg::Authority& m) { authorities.emplace_back(m, Clock::now()); });
    command_.take([this](const msg::JointCommand& m) {
      if (!commands.empty() && !same_setpoints(commands.back(), m)) {
        changed = Clock::now();
        changed_tick = m.header.tick;
      }
      commands.push_back(m);
    });
    joints_.take([this](const msg::JointState& m) { joints.push_back(m); });
    mission_.take([this](const msg::MissionStatus& m) { mission = m; });
    task_.take([this](const msg::TaskStatus& m) { task = m; });
  }
  [[nodiscard]] bool wait_for_level(std::uint8_t level, std::chrono::milliseconds bound = std::chrono::seconds(30)) {
    return eventually(
        [&] {
          poll();
          return !authorities.empty() && authorities.back().first.level == level;
        },
        bound);
  }
  [[nodiscard]] static bool same_setpoints(const msg::JointCommand& a, const msg::JointCommand& b) {
    return std::equal(a.position_rad, a.position_rad + a.joint_count, b.position_rad);
  }
  /// Waits until the setpoint of joint 8 changes; false if it does not within the bound of eventually().
  [[nodiscard]] bool moves() {
    const std::size_t from = commands.size();
    return eventually([&] {
      poll();
      return commands.size() > from + 5 && commands.back().position_rad[8] != commands[from].position_rad[8];
    });
  }

  /// For more readers in this process.
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }

  std::vector<std::pair<msg::Authority, Clock::time_point>> authorities;
  std::vector<msg::JointCommand> commands;
  Clock::time_point changed{};     ///< when the last command arrived whose setpoints differ from those before
  std::int64_t changed_tick = -1;  ///< the tick of this command
  std::vector<msg::JointState> joints;
  msg::MissionStatus mission{};
  msg::TaskStatus task{};

 private:
  template <class T>
  [[nodiscard]] dds::Reader<T> reader(const Topic<T>& topic) const {
    return dds::Reader<T>::member(domain_.participant(), std::string(topic.name));
  }
  dds::Domain domain_;
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::JointCommand> command_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::MissionStatus> mission_;
  dds::Reader<msg::TaskStatus> task_;
};

/// The greatest speed of any setpoint [rad/s]. A hold or a takeover begins in the ticks of `begun`. In these ticks a
/// setpoint may also jump to the measured angle of its joint and move on from there; at real-time pace the measurement
/// may be one tick older or newer.
inline double fastest_setpoint(const Watcher& watcher, const std::set<std::int64_t>& begun) {
  std::map<std::int64_t, const msg::JointState*> measured;
  for (const auto& state : watcher.joints) measured[state.header.tick] = &state;
  double fastest_rad_s = 0.0;
  for (std::size_t i = 1; i < watcher.commands.size(); ++i) {
    const msg::JointCommand& command = watcher.commands[i];
    const std::int64_t tick = command.header.tick;
    const double dt_s = kTick_s * static_cast<double>(tick - watcher.commands[i - 1].header.tick);
    for (int j = 0; j < command.joint_count; ++j) {
      double step_rad = std::abs(command.position_rad[j] - watcher.commands[i - 1].position_rad[j]);
      for (std::int64_t k = tick - 1; begun.contains(tick) && k <= tick + 1; ++k) {
        if (measured.contains(k))
          step_rad = std::min(step_rad, std::abs(command.position_rad[j] - measured[k]->position_rad[j]));
      }
      fastest_rad_s = std::max(fastest_rad_s, step_rad / dt_s);
    }
  }
  return fastest_rad_s;
}

/// The greatest measured speed of any joint [rad/s] from tick `from` on, before tick `to`.
inline double fastest_joint(const Watcher& watcher, std::int64_t from,
                            std::int64_t to = std::numeric_limits<std::int64_t>::max()) {
  double fastest_rad_s = 0.0;
  for (const auto& state : watcher.joints) {
    const bool counts = state.header.tick >= from && state.header.tick < to;
    for (int j = 0; counts && j < state.joint_count; ++j) {
      fastest_rad_s = std::max(fastest_rad_s, std::abs(state.velocity_rad_s[j]));
    }
  }
  return fastest_rad_s;
}

/// Expects that in the tick after `latched` each setpoint is the one of the tick before, or the measured angle of its
/// joint.
inline void expect_hold_begins_after(const Watcher& watcher, std::int64_t latched) {
  const auto of_tick = [](const auto& messages, std::int64_t tick) {
    const auto found =
        std::find_if(messages.begin(), messages.end(), [&](const auto& m) { return m.header.tick == tick; });
    return found == messages.end() ? nullptr : &*found;
  };
  const auto* before = of_tick(watcher.commands, latched);
  const auto* first = of_tick(watcher.commands, latched + 1);
  const auto* measured = of_tick(watcher.joints, latched + 1);
  ASSERT_TRUE(before && first && measured) << "the observer missed a message of tick " << latched;
  for (int j = 0; j < first->joint_count; ++j) {
    EXPECT_TRUE(first->position_rad[j] == before->position_rad[j] ||
                first->position_rad[j] == measured->position_rad[j])
        << "joint " << j;
  }
}

/// The range of the angle [rad] of the joint that moves most, from tick `from` to tick `to`.
inline double widest_range(const Watcher& watcher, std::int64_t from, std::int64_t to) {
  double widest_rad = 0.0;
  for (int j = 0; j < watcher.joints.back().joint_count; ++j) {
    double least_rad = 1e9;
    double most_rad = -1e9;
    for (const auto& state : watcher.joints) {
      if (state.header.tick < from || state.header.tick > to) continue;
      least_rad = std::min(least_rad, state.position_rad[j]);
      most_rad = std::max(most_rad, state.position_rad[j]);
    }
    widest_rad = std::max(widest_rad, most_rad - least_rad);
  }
  return widest_rad;
}

}  // namespace constrictor::testing
