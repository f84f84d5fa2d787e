#include "conform/hardware_port.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include "constrictor/reflect.hpp"

namespace constrictor::conform {
namespace {

constexpr int kDepth = 64;
constexpr int kLastHolds = 5;

std::int64_t now_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

std::uint64_t random_session() {
  std::random_device random;
  return (std::uint64_t{random()} << 32 | random()) | 1;
}

}  // namespace

HardwarePort::HardwarePort(std::uint32_t domain, double period_s, std::uint16_t robot_id,
                           std::function<bool()> interrupted, std::function<std::string()> restart)
    : domain_(domain),
      robot_id_(robot_id),
      period_ns_(std::llround(period_s * 1e9)),
      interrupted_(std::move(interrupted)),
      restart_(std::move(restart)),
      wait_set_(domain_.participant()),
      next_ns_(now_ns()),
      session_(random_session()) {
  namespace wire = barrier_topics;
  const dds_entity_t here = domain_.participant();
  states_ = dds::Reader<msg::HardwareJointState>::observer(here, wire::kHardwareJointState.name, kDepth);
  inertial_ = dds::Reader<msg::HardwareImuState>::observer(here, wire::kHardwareImuState.name, kDepth);
  felt_ = dds::Reader<msg::HardwareContactState>::observer(here, wire::kHardwareContactState.name, kDepth);
  others_ = dds::Reader<msg::HardwareJointCommand>::observer(here, wire::kHardwareJointCommand.name, 1);
  writer_ = {here, wire::kHardwareJointCommand};
  wait_set_.attach(states_.get());
}

HardwarePort::~HardwarePort() {
  try {
    hold();
  } catch (const dds::Error&) {  // the joints hold by themselves when no commands arrive
  }
}

double HardwarePort::now_s() const { return 1e-9 * static_cast<double>(now_ns()); }

void HardwarePort::begin_session() {
  session_ = random_session();
  number_ = 0;
}

void HardwarePort::send(const PlantCommand& command) {
  using Origin = PlantCommand::Origin;
  msg::HardwareJointCommand message{};
  message.robot_id = robot_id_;
  message.session = command.origin == Origin::kStranger ? session_ ^ 0x5555 : session_;
  if (command.origin == Origin::kProper) {
    ++number_;
    limits_nm_ = command.torque_limit_nm;
  }
  message.sequence_number = command.origin == Origin::kOld        ? 1
                            : command.origin == Origin::kStranger ? 1'000'000 + number_
                                                                  : number_;
  message.period_ns = period_ns_;
  message.mode = command.unknown_mode ? 7
                 : command.relaxed    ? msg::kServoRelaxed
                 : command.torque     ? msg::kServoTorque
                                      : msg::kServoFollow;
  const std::size_t count = std::min<std::size_t>(command.position_rad.size(), msg::kMaxJoints);
  message.joint_count = static_cast<std::uint16_t>(count);
  std::copy_n(command.position_rad.begin(), count, message.position_rad);
  std::copy_n(command.velocity_rad_s.begin(), count, message.velocity_rad_s);
  std::copy_n(command.torque_limit_nm.begin(), count, message.torque_limit_nm);
  std::copy_n(command.torque_nm.begin(), count, message.torque_nm);
  writer_.write(message);
}

void HardwarePort::take() {
  const double arrival_s = now_s();
  states_.take([&](const msg::HardwareJointState& state) {
    if (state.robot_id != robot_id_) return;
    JointSample sample;
    sample.session = state.session;
    sample.number = state.sequence_number;
    sample.time_ns = state.time_ns;
    sample.arrival_s = arrival_s;
    sample.confirmed_session = state.command_session;
    sample.confirmed_number = state.command_number;
    sample.holding = state.holding;
    sample.fault = printable(text_of(state.fault));
    const std::size_t count = std::min<std::size_t>(state.joint_count, msg::kMaxJoints);
    sample.position_rad.assign(state.position_rad, state.position_rad + count);
    sample.velocity_rad_s.assign(state.velocity_rad_s, state.velocity_rad_s + count);
    sample.torque_nm.assign(state.torque_nm, state.torque_nm + count);
    posture_rad_ = sample.position_rad;
    incarnation_ = sample.session;
    joints_.push_back(std::move(sample));
  });
  inertial_.take([&](const msg::HardwareImuState& imu) {
    const auto& q = imu.orientation;
    const auto &w = imu.angular_velocity_rad_s, &a = imu.linear_acceleration_m_s2;
    if (imu.robot_id == robot_id_) imus_.push_back({{q.w, q.x, q.y, q.z}, {w.x, w.y, w.z}, {a.x, a.y, a.z}});
  });
  felt_.take([&](const msg::HardwareContactState& contact) {
    if (contact.robot_id == robot_id_)
      contacts_.push_back({contact.module_count, contact.contact_count, !validate(contact)});
  });
}

void HardwarePort::advance(const std::vector<PlantCommand>& commands) {
  if (interrupted_()) throw Interrupted();
  joints_.clear();
  imus_.clear();
  contacts_.clear();
  for (const auto& command : commands) send(command);
  next_ns_ = std::max(next_ns_ + period_ns_, now_ns());
  for (std::int64_t left_ns = period_ns_; left_ns > 0; left_ns = next_ns_ - now_ns()) {
    const auto left = std::chrono::nanoseconds(left_ns);
    // Waits have whole milliseconds; the rest of the period is slept.
    const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(left);
    if (whole.count() > 0) wait_set_.wait(whole);
    else std::this_thread::sleep_for(left);
    take();
  }
}

void HardwarePort::hold() {
  if (number_ == 0 || posture_rad_.empty() || posture_rad_.size() != limits_nm_.size()) return;
  if (!std::all_of(posture_rad_.begin(), posture_rad_.end(), [](double angle) { return std::isfinite(angle); })) return;
  PlantCommand command;
  command.position_rad = posture_rad_;
  command.velocity_rad_s.resize(posture_rad_.size());
  command.torque_limit_nm = limits_nm_;
  command.torque_nm.resize(posture_rad_.size());
  for (int i = 0; i < kLastHolds; ++i) {
    send(command);
    std::this_thread::sleep_for(std::chrono::nanoseconds(period_ns_));
  }
}

}  // namespace constrictor::conform
