// outside_plant: drives joints for `plant_relay` from outside the barrier, on Cyclone DDS's C interface. It uses the
// IDL files of Constrictor and the rules in idl/README.md, "Hardware topics", but none of its headers and libraries.
#include <dds/dds.h>
#include <time.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "hardware.h"
#include "joints.hpp"
#include "options.hpp"

namespace {

using JointState = constrictor_msg_HardwareJointState;
using ImuState = constrictor_msg_HardwareImuState;
using JointCommand = constrictor_msg_HardwareJointCommand;

// Constrictor uses UDP on the loopback interface, without multicast, on one host.
constexpr const char* kLoopback = R"(<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>)";
constexpr long kPeriod_ns = 10'000'000;  // twice in each control period, so that plant_relay never waits for a sample

constexpr int kDepth = 8;  // with 1, a stranger's command could replace the right one before it is read

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

dds_entity_t made(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  std::fprintf(stderr, "outside_plant: cannot create %s: %s\n", what, dds_strretcode(-entity));
  std::exit(70);
}

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

class Process {
 public:
  Process(std::uint32_t domain, std::size_t joints) : joints_(joints) {
    if (!std::getenv("CYCLONEDDS_URI")) made(dds_create_domain(domain, kLoopback), "a domain");
    participant_ = made(dds_create_participant(domain, nullptr, nullptr), "a participant");
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kDepth);
    commands_ =
        made(dds_create_reader(participant_, topic(constrictor_msg_HardwareJointCommand_desc, "hardware/joint_command"),
                               qos, nullptr),
             "a reader");
    states_ =
        made(dds_create_writer(participant_, topic(constrictor_msg_HardwareJointState_desc, "hardware/joint_state"),
                               qos, nullptr),
             "a writer");
    imus_ = made(dds_create_writer(participant_, topic(constrictor_msg_HardwareImuState_desc, "hardware/imu_state"),
                                   qos, nullptr),
                 "a writer");
    dds_delete_qos(qos);
    std::random_device random;
    session_ = (std::uint64_t{random()} << 32 | random()) | 1;
  }
  ~Process() { dds_delete(participant_); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// One period: obey, move, measure.
  void step() {
    const std::int64_t time_ns = now_ns();
    const double now_s = static_cast<double>(time_ns) * 1e-9;
    take_commands(now_s);
    joints_.move(now_s);
    write_state(time_ns);
  }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const char* name) {
    return made(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
  }

  void take_commands(double now_s) {
    void* samples[kDepth] = {};
    dds_sample_info_t infos[kDepth];
    const int count = dds_take(commands_, samples, infos, kDepth, kDepth);
    for (int i = 0; i < count; ++i) {
      const auto& message = *static_cast<const JointCommand*>(samples[i]);
      if (infos[i].valid_data && message.robot_id == 1) take_command(message, now_s);
    }
    if (count > 0) dds_return_loan(commands_, samples, count);
  }

  void take_command(const JointCommand& message, double now_s) {
    example::Command command;
    command.session = message.session;
    command.number = message.sequence_number;
    command.relaxed = message.mode == constrictor_msg_kServoRelaxed;
    command.torque = message.mode == constrictor_msg_kServoTorque;
    command.mode_known = command.relaxed || command.torque || message.mode == constrictor_msg_kServoFollow;
    const std::size_t joints = std::min<std::size_t>(message.joint_count, constrictor_msg_kMaxJoints);
    command.position_rad.assign(message.position_rad, message.position_rad + joints);
    command.torque_limit_nm.assign(message.torque_limit_nm, message.torque_limit_nm + joints);
    command.torque_nm.assign(message.torque_nm, message.torque_nm + joints);
    joints_.take(command, now_s);
  }

  void write_state(std::int64_t time_ns) {
    ++number_;
    JointState state{};
    state.robot_id = 1;
    state.session = session_;
    state.sequence_number = number_;
    state.time_ns = time_ns;
    state.command_session = joints_.session();
    state.command_number = joints_.number();
    state.holding = joints_.holding();
    state.joint_count = static_cast<std::uint16_t>(joints_.count());
    for (std::size_t i = 0; i < joints_.count(); ++i) {
      state.position_rad[i] = joints_.position_rad(i);
      state.velocity_rad_s[i] = joints_.velocity_rad_s(i);
      state.torque_nm[i] = joints_.torque_nm(i);
    }
    dds_write(states_, &state);
    ImuState imu{};
    imu.robot_id = 1;
    imu.session = session_;
    imu.sequence_number = number_;
    imu.time_ns = time_ns;
    imu.orientation.w = 1.0;  // the model lies still on flat ground
    imu.linear_acceleration_m_s2.z = 9.81;
    dds_write(imus_, &imu);
  }

  example::Joints joints_;
  dds_entity_t participant_ = 0, commands_ = 0, states_ = 0, imus_ = 0;
  std::uint64_t session_ = 0, number_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const example::Options options = example::read_options("outside_plant", constrictor_msg_kMaxJoints, argc, argv);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  Process process(options.domain, options.joints);
  std::printf("outside_plant: %zu joints in domain %u\n", options.joints, options.domain);
  std::fflush(stdout);
  std::int64_t next_ns = now_ns();
  while (!g_stop) {
    process.step();
    next_ns += kPeriod_ns;
    if (now_ns() > next_ns + 10 * kPeriod_ns) next_ns = now_ns();  // this process was stopped: do not catch up
    timespec until{};
    until.tv_sec = static_cast<time_t>(next_ns / 1'000'000'000);
    until.tv_nsec = static_cast<long>(next_ns % 1'000'000'000);
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
}
