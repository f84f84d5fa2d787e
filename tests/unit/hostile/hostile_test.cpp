// Messages with absurd values on every input of every component: the component finishes each step, every output is
// finite and within its range and the robot's limits, and memory does not grow.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "barrier/member.hpp"
#include "barrier/topic_ops.hpp"
#include "component/data_path.hpp"
#include "constrictor/messages.hpp"
#include "control/control_method.hpp"
#include "host/known_components.hpp"
#include "hostile_filler.hpp"
#include "resident_memory.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::testing {
namespace {

/// Number of messages for each input and tick. One step of the simulated world or one image takes milliseconds; these
/// components receive a million messages in fewer ticks, so that their test does not take several minutes.
int burst_of(const std::string& component) {
  const bool costly = component == "physics" || component == "camera" || component == "overview";
  return costly && kMessages > 100'000 ? 32 : 8;
}

/// Checks every message that a component writes.
class OutputChecker : public MemberSink {
 public:
  explicit OutputChecker(const RobotModel& robot) : robot_(robot) {}
  void publish(const TopicInfo& topic, const Sample& sample) override {
    ++outputs;
    const auto violation = topic_ops(topic.id).validate(sample.message.get());
    EXPECT_FALSE(violation) << topic.name << "." << *violation;
    if (topic.id != topics::kJointCommand.id) return;
    const auto& command = *static_cast<const msg::JointCommand*>(sample.message.get());
    ASSERT_EQ(command.joint_count, robot_.joints.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const JointModel& joint = robot_.joints[j];
      ASSERT_TRUE(command.position_rad[j] >= joint.min_rad && command.position_rad[j] <= joint.max_rad)
          << command.position_rad[j];
      ASSERT_TRUE(std::abs(command.velocity_rad_s[j]) <= joint.max_speed_rad_s) << command.velocity_rad_s[j];
      ASSERT_TRUE(command.torque_limit_nm[j] >= 0.0 && command.torque_limit_nm[j] <= joint.max_torque_nm)
          << command.torque_limit_nm[j];
    }
  }
  void done(const TickDone& step) override { largest_state = std::max(largest_state, step.state.size()); }

  std::uint64_t outputs = 0;
  std::size_t largest_state = 0;

 private:
  const RobotModel& robot_;
};

/// Gives some fields, most of the time, a value that components react to. Random values alone would mostly be ignored.
void make_relevant(msg::JointState& m, HostileFiller& f) {
  if (f.roll(4) != 0) m.joint_count = 23;
}
void make_relevant(msg::JointCommand& m, HostileFiller& f) {
  if (f.roll(4) != 0) m.joint_count = 23;
  for (double& position : m.position_rad) {
    if (f.roll(2) == 0) position = std::remainder(position, 1.5);
    if (!std::isfinite(position) && f.roll(4) != 0) position = 0.3;
  }
}
void make_relevant(msg::DesiredTrajectory& m, HostileFiller& f) {
  static const MethodRegistry methods;
  auto names = methods.names();
  names.insert(names.end(), {"travel", "carry", "creep", "seat", "deliver", "leave", "stand"});
  if (f.roll(4) != 0) std::snprintf(m.motion, sizeof m.motion, "%s", names[f.roll(names.size())].data());
  if (f.roll(3) != 0) m.point_count = static_cast<std::uint16_t>(f.roll(msg::kMaxTrajectoryPoints + 1));
  if (f.roll(2) == 0) {
    for (int i = 0; i < msg::kMaxTrajectoryPoints; ++i) m.points[i].arc_m = 0.1 * i;
  }
  if (f.roll(3) != 0) m.shape_count = static_cast<std::uint16_t>(f.roll(13));
  if (f.roll(3) != 0) m.motion_id = f.roll(3);
}
void make_relevant(msg::TaskEvent& m, HostileFiller& f) {
  if (f.roll(2) == 0) m.goal_id = (std::uint64_t{1} << 48) + f.roll(20);
}
void make_relevant(msg::TaskStatus& m, HostileFiller& f) {
  if (f.roll(2) == 0) m.goal_id = (std::uint64_t{1} << 48) + f.roll(20);
}
constexpr const char* kParameters[] = {"navigation.travel.speed_m_s", "control.squeeze.opening_share",
                                       "perception.colour.min_chroma", "guidance.landmarks.confirm"};
void make_relevant(msg::Request& m, HostileFiller& f) {
  static constexpr const char* kSources[] = {"planner", "pilot", "machine", "script"};
  if (f.roll(4) != 0) std::snprintf(m.source, sizeof m.source, "%s", kSources[f.roll(4)]);
  if (f.roll(4) != 0) m.goal_id = f.roll(1000);
  if (f.roll(2) == 0) std::snprintf(m.parameter, sizeof m.parameter, "%s", kParameters[f.roll(4)]);
  if (f.roll(2) == 0) m.parameter_value = static_cast<double>(f.roll(3));
  if (f.roll(2) == 0) m.effective_tick = f.roll(2) == 0 ? 0 : static_cast<std::int64_t>(f.roll(100'000));
}
void make_relevant(msg::ParameterChange& m, HostileFiller& f) {
  if (f.roll(4) != 0) std::snprintf(m.name, sizeof m.name, "%s", kParameters[f.roll(4)]);
  if (f.roll(4) != 0) m.value = f.roll(3) == 0 ? 0.7 : static_cast<double>(f.roll(100));
  if (f.roll(4) != 0) m.effective_tick = static_cast<std::int64_t>(f.roll(100'000));
}
void make_relevant(msg::ParameterList& m, HostileFiller& f) {
  if (f.roll(4) == 0 || m.count == 0) return;
  std::snprintf(m.parameters[0].name, sizeof m.parameters[0].name, "%s", kParameters[f.roll(4)]);
  m.parameters[0].minimum = 0.0;
  m.parameters[0].maximum = 1.0;
}
template <class T>
void make_relevant(T&, HostileFiller&) {}

std::vector<std::uint8_t> g_pixels(48 * 32 * 3);

void make_relevant(msg::CameraInfo& m, HostileFiller& f) {
  if (f.roll(8) == 0) return;
  m.width = 48;
  m.height = 32;
  if (f.roll(4) == 0) return;
  m.fx = m.fy = 24.0;
  m.cx = 24.0;
  m.cy = 16.0;
  m.X_HC = {{0.06, 0.0, 0.05}, {0.5, -0.5, 0.5, -0.5}};
  m.frame_period_s = 0.1;
}

void make_relevant(msg::CameraImage& m, HostileFiller& f) {
  if (f.roll(4) == 0) return;  // size and data then contradict each other
  const bool expected = f.roll(4) != 0;
  m.width = expected ? std::uint16_t{48} : static_cast<std::uint16_t>(1 + f.roll(48));
  m.height = expected ? std::uint16_t{32} : static_cast<std::uint16_t>(1 + f.roll(32));
  for (auto& pixel : g_pixels) pixel = static_cast<std::uint8_t>(f.roll(256));
  const auto length = static_cast<std::uint32_t>(m.width * m.height * 3);
  m.data = {length, length, g_pixels.data(), false};
}

/// A message of a topic with absurd values and with the header that the barrier expects.
template <class T>
Sample hostile(const Topic<T>& topic, const msg::Header& header, HostileFiller& filler) {
  static T message{};
  message = T{};
  filler.begin_message();
  Description<T>::visit(message, filler);
  make_relevant(message, filler);
  return topic_ops(topic.id).stamp(&message, header, 1);
}

Sample hostile(std::size_t id, const msg::Header& header, HostileFiller& filler) {
  Sample sample;
  std::apply([&](const auto&... topic) { ((topic.id == id ? (sample = hostile(topic, header, filler), 0) : 0), ...); },
             topics::kAll);
  return sample;
}

class Hostile : public ::testing::TestWithParam<std::string> {};

TEST_P(Hostile, MessagesNeitherStopStepsNorCauseOutputsOutsideTheirLimits) {
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/case_study.yaml");
  setup.mission = "{sequence: [green, red], line_colour: blue}";
  const RobotModel robot = load_robot(setup.robot_file);
  OutputChecker checker(robot);
  const ComponentFactory factory = known_components().at(GetParam())();
  const bool plant = factory.name == "physics";
  Member member(factory, setup, 1, /*checkpoints=*/!plant, checker);
  const EpochId epoch{7, 1};
  member.on_epoch(epoch, 1);
  HostileFiller filler(kSeed);
  std::vector<std::size_t> inputs;
  for (const auto& topic : topics::kInfos) {
    if (member.reads().contains(topic.id)) inputs.push_back(topic.id);
  }
  ASSERT_FALSE(inputs.empty());
  const std::uint64_t budget = kMessages;
  const int burst = burst_of(factory.name);
  std::array<std::uint64_t, topics::kCount> counts{};
  std::uint64_t sent = 0;
  double early_mib = 0.0;
  std::uint64_t outputs_before = 0;  // within the first two thirds
  std::int64_t tick = 0;
  for (; sent < budget; ++tick) {
    msg::Tick message{};
    message.run_id = epoch.run_id;
    message.epoch = epoch.epoch;
    message.index = tick;
    message.time_ns = tick * 20'000'000;
    message.period_ns = 20'000'000;
    for (const std::size_t id : inputs) {
      for (int i = 0; i < burst; ++i, ++sent) {
        const msg::Header header{epoch.run_id, epoch.epoch, 1, tick, message.time_ns, ++counts[id]};
        member.on_sample(id, hostile(id, header, filler));
      }
      message.visible[id] = counts[id];
      message.incarnations[id] = 1;
    }
    if (member.client_requests()) {
      for (int i = 0; i < burst; ++i, ++sent) {
        msg::Header header{};
        header.sequence_number = static_cast<std::uint64_t>(tick) * 10 + static_cast<std::uint64_t>(i);
        member.client_requests()->add(
            *static_cast<const msg::Request*>(hostile(topics::kPlannerRequest, header, filler).message.get()));
        if (i == 0) member.client_requests()->add_death("pilot");
      }
    }
    if (plant) member.sample_plant(tick, message.time_ns, message.period_ns);
    member.on_tick(message);
    const bool due = tick % member.timing().period == 0;
    // Until the first valid sample of each input has arrived, a component may wait.
    const bool stepped = member.try_step();
    if (tick > 50) {
      ASSERT_EQ(stepped, due) << "tick " << tick;
    }
    if (::testing::Test::HasFailure()) break;
    if (sent < budget / 3) early_mib = resident_mib();
    if (sent < budget / 3 * 2) outputs_before = checker.outputs;
  }
  const double late_mib = resident_mib();
  std::printf("%s: %llu messages in %lld ticks, %llu outputs, %llu refused, state %zu bytes, memory %.1f to %.1f MiB\n",
              factory.name.c_str(), static_cast<unsigned long long>(sent), static_cast<long long>(tick),
              static_cast<unsigned long long>(checker.outputs),
              static_cast<unsigned long long>(member.counters().refused), checker.largest_state, early_mib, late_mib);
  const bool silent = factory.name == "report";  // it has no outputs
  EXPECT_TRUE(silent || checker.outputs > outputs_before) << "the component stopped writing";
  EXPECT_GT(member.counters().refused, 0u);
  EXPECT_LT(checker.largest_state, 300'000u);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers keep freed memory
  EXPECT_LT(late_mib - early_mib, 16.0);
#endif
}

/// All components but two: servo_bus needs servos, and plant_relay a process outside the barrier. tests/unit/servo_bus
/// and tests/unit/plant_relay send them absurd commands and measurements.
std::vector<std::string> tried_components() {
  std::vector<std::string> names;
  for (const auto& [name, make] : known_components()) {
    if (name != "servo_bus" && name != "plant_relay") names.push_back(name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(EveryComponent, Hostile, ::testing::ValuesIn(tried_components()),
                         [](const auto& made) { return made.param; });

TEST(HostileTest, CoversEveryComponent) {
  EXPECT_EQ(known_components().size(), 10u + 2u) << "a new component is tried by itself; it is only counted here";
  EXPECT_EQ(tried_components().size(), 10u);
}

}  // namespace
}  // namespace constrictor::testing
