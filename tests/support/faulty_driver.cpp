// faulty_driver DOMAIN JOINTS FAULT: a driver outside the barrier, on the topics hardware/*, whose joints are numbers
// (faulty_joints.hpp), with the fault of this name; an empty name means none. SIGUSR1 restarts it.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/host.hpp"
#include "support/faulty_joints.hpp"

namespace constrictor::testing {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPeriod = std::chrono::milliseconds(10);
constexpr std::uint16_t kRobot = 1;
volatile std::sig_atomic_t g_restart = 0;

class FaultyDriver {
 public:
  FaultyDriver(std::uint32_t domain, std::size_t joints, const std::string& fault)
      : domain_(domain), joints_(joints, fault), modules_(joints + 1) {
    const dds_entity_t here = domain_.participant();
    // With a depth of 1, a stranger's command could replace the right one before it is read.
    commands_ = dds::Reader<msg::HardwareJointCommand>::observer(here, barrier_topics::kHardwareJointCommand.name, 8);
    states_ = {here, barrier_topics::kHardwareJointState};
    imus_ = {here, barrier_topics::kHardwareImuState};
    contacts_ = {here, barrier_topics::kHardwareContactState};
  }
  /// As a new process does; the joints stay where they are.
  void restart() { joints_.restart(); }
  /// One period: obeys, moves, measures.
  void step(double now_s, double passed_s) {
    commands_.take([&](const msg::HardwareJointCommand& message) {
      if (message.robot_id == kRobot)
        joints_.take(command_of(message), message.session, message.sequence_number, now_s);
    });
    joints_.move(now_s, passed_s);
    conform::JointSample sample;
    if (joints_.measure(now_s, sample)) write(sample);
    const auto time_ns = static_cast<std::int64_t>(now_s * 1e9);
    ++number_;
    msg::HardwareImuState imu{};
    imu.robot_id = kRobot;
    imu.session = joints_.own_session;
    imu.sequence_number = number_;
    imu.time_ns = time_ns;
    imu.orientation.w = 1.0;
    imu.linear_acceleration_m_s2.z = joints_.has("gravity_down") ? -9.81 : 9.81;
    imus_.write(imu);
    msg::HardwareContactState contacts{};
    contacts.robot_id = kRobot;
    contacts.session = joints_.own_session;
    contacts.sequence_number = number_;
    contacts.time_ns = time_ns;
    contacts.module_count = static_cast<std::uint16_t>(joints_.has("few_modules") ? 3 : modules_);
    contacts_.write(contacts);
  }

 private:
  static conform::PlantCommand command_of(const msg::HardwareJointCommand& message) {
    conform::PlantCommand command;
    const std::size_t count = std::min<std::size_t>(message.joint_count, msg::kMaxJoints);
    command.position_rad.assign(message.position_rad, message.position_rad + count);
    command.velocity_rad_s.assign(message.velocity_rad_s, message.velocity_rad_s + count);
    command.torque_limit_nm.assign(message.torque_limit_nm, message.torque_limit_nm + count);
    command.torque_nm.assign(message.torque_nm, message.torque_nm + count);
    command.relaxed = message.mode == msg::kServoRelaxed;
    command.torque = message.mode == msg::kServoTorque;
    command.unknown_mode = !command.relaxed && !command.torque && message.mode != msg::kServoFollow;
    return command;
  }
  void write(const conform::JointSample& sample) {
    msg::HardwareJointState state{};
    state.robot_id = kRobot;
    state.session = sample.session;
    state.sequence_number = sample.number;
    state.time_ns = sample.time_ns;
    state.command_session = sample.confirmed_session;
    state.command_number = sample.confirmed_number;
    state.holding = sample.holding;
    set_text(state.fault, sample.fault);
    state.joint_count = static_cast<std::uint16_t>(sample.position_rad.size());
    std::copy(sample.position_rad.begin(), sample.position_rad.end(), state.position_rad);
    std::copy(sample.velocity_rad_s.begin(), sample.velocity_rad_s.end(), state.velocity_rad_s);
    std::copy(sample.torque_nm.begin(), sample.torque_nm.end(), state.torque_nm);
    states_.write(state);
  }

  dds::Domain domain_;
  FaultyJoints joints_;
  std::size_t modules_;
  std::uint64_t number_ = 0;
  dds::Reader<msg::HardwareJointCommand> commands_;
  dds::Writer<msg::HardwareJointState> states_;
  dds::Writer<msg::HardwareImuState> imus_;
  dds::Writer<msg::HardwareContactState> contacts_;
};

}  // namespace
}  // namespace constrictor::testing

int main(int argc, char** argv) {
  using namespace constrictor;
  using namespace constrictor::testing;
  if (argc != 4) return exit_status::kUsage;
  FaultyDriver driver(static_cast<std::uint32_t>(std::atoi(argv[1])), static_cast<std::size_t>(std::atoi(argv[2])),
                      argv[3]);
  // It ends with the process that started it, by its signal.
  std::signal(SIGUSR1, [](int) { g_restart = 1; });
  auto before = Clock::now(), next = before;
  for (;;) {
    next = std::max(next + kPeriod, Clock::now());
    std::this_thread::sleep_until(next);
    const auto now = Clock::now();
    if (g_restart) driver.restart();
    g_restart = 0;
    driver.step(std::chrono::duration<double>(now.time_since_epoch()).count(),
                std::chrono::duration<double>(now - before).count());
    before = now;
  }
}
