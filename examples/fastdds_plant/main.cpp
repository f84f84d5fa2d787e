// fastdds_plant: the same as outside_plant on Fast DDS. It drives joints for `plant_relay` from outside the barrier
// with the IDL files of Constrictor and the rules in idl/README.md, "Hardware topics", and nothing else of it.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <thread>

#include "hardwarePubSubTypes.h"
#include "joints.hpp"
#include "options.hpp"
#include "participant.hpp"

namespace {

namespace msg = constrictor::msg;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod{10};  // twice in each control period

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

void run(std::uint32_t domain, std::size_t count) {
  example::Participant participant(domain, "fastdds_plant");
  example::Joints joints(count);
  const auto now_s = [] { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); };
  participant.read<msg::HardwareJointCommandPubSubType>(
      "hardware/joint_command", false, 8, [&](const msg::HardwareJointCommand& message) {
        if (message.robot_id() != 1) return;
        example::Command command;
        command.session = message.session();
        command.number = message.sequence_number();
        command.relaxed = message.mode() == msg::kServoRelaxed;
        command.torque = message.mode() == msg::kServoTorque;
        command.mode_known = command.relaxed || command.torque || message.mode() == msg::kServoFollow;
        const std::size_t used = std::min<std::size_t>(message.joint_count(), msg::kMaxJoints);
        command.position_rad.assign(message.position_rad().begin(), message.position_rad().begin() + used);
        command.torque_limit_nm.assign(message.torque_limit_nm().begin(), message.torque_limit_nm().begin() + used);
        command.torque_nm.assign(message.torque_nm().begin(), message.torque_nm().begin() + used);
        joints.take(command, now_s());
      });
  auto* states = participant.write<msg::HardwareJointStatePubSubType>("hardware/joint_state", 1, false);
  auto* imus = participant.write<msg::HardwareImuStatePubSubType>("hardware/imu_state", 1, false);
  std::random_device random;
  const std::uint64_t session = (std::uint64_t{random()} << 32 | random()) | 1;
  std::printf("fastdds_plant: %zu joints in domain %u\n", count, domain);
  std::fflush(stdout);

  auto next = Clock::now();
  for (std::uint64_t sample = 1; !g_stop; ++sample) {
    participant.wait(0.0);
    const auto now = Clock::now().time_since_epoch();
    joints.move(std::chrono::duration<double>(now).count());
    const std::int64_t time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
    msg::HardwareJointState state;
    state.robot_id(1);
    state.session(session);
    state.sequence_number(sample);
    state.time_ns(time_ns);
    state.command_session(joints.session());
    state.command_number(joints.number());
    state.holding(joints.holding());
    state.joint_count(static_cast<std::uint16_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
      state.position_rad()[i] = joints.position_rad(i);
      state.velocity_rad_s()[i] = joints.velocity_rad_s(i);
      state.torque_nm()[i] = joints.torque_nm(i);
    }
    states->write(&state);
    msg::HardwareImuState imu;
    imu.robot_id(1);
    imu.session(session);
    imu.sequence_number(sample);
    imu.time_ns(time_ns);
    imu.orientation().w(1.0);  // the model lies still on flat ground
    imu.linear_acceleration_m_s2().z(9.81);
    imus->write(&imu);
    next += kPeriod;
    if (Clock::now() > next + 10 * kPeriod) next = Clock::now();  // this process was stopped: do not catch up
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const example::Options options = example::read_options("fastdds_plant", msg::kMaxJoints, argc, argv);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  try {
    run(options.domain, options.joints);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fastdds_plant: %s\n", error.what());
    return 70;
  }
}
