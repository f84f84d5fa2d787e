#include "plant_relay/plant_relay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cmath>

#include "component/default_robot.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/archive.hpp"
#include "constrictor/text.hpp"
#include "robot/gate_messages.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kSamplesInARow = 3;  // that make a posture known

/// A number that differs for each run, epoch and start of the relay; never 0. (splitmix64)
std::uint64_t session_of(const Tick& tick, std::uint64_t starts) {
  std::uint64_t mixed = tick.run_id ^ (std::uint64_t{tick.epoch} << 32) ^ (starts * 0x9e3779b97f4a7c15ULL);
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9ULL;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebULL;
  return (mixed ^ (mixed >> 31)) | 1;
}

}  // namespace

PlantRelay::PlantRelay(Wiring& wiring, const Setup& setup)
    : wiring_(wiring),
      config_(load_parameters<PlantRelayConfig>(setup.config_file)),
      robot_(load_robot(robot_file_of(setup))),
      judge_(robot_, config_),
      gate_(wiring, robot_, config_.gate_limits()),
      link_(wiring.hardware_link()) {
  state_.angles_rad.resize(robot_.joints.size());
  state_.velocities_rad_s.resize(robot_.joints.size());
  state_.torques_nm.resize(robot_.joints.size());
}

void PlantRelay::refuse(const std::string& reason) {
  last_refusal_ = reason;
  wiring_.count_refusal(reason);
}

void PlantRelay::sample(const Tick& tick) {
  HardwareLink::Arrived arrived;
  if (link_) arrived = link_->take();
  for (const auto& reason : arrived.refused) refuse(reason);
  take_joints(tick, arrived.joints);
  if (!state_.following && !state_.measured && !continued_ && tick.index >= config_.patience_ticks())
    throw ConfigurationError(fmt::format(
        "hardware/joint_state: found no acceptable sample within {:.0f} s{}{}; start the process that drives the "
        "joints in this DDS domain (idl/README.md, \"Hardware topics\")",
        config_.patience_s, last_refusal_.empty() ? "" : "; last refusal: ", last_refusal_));
  gate_.sample(tick);
  if (state_.measured) write_joints();
  write_contacts(arrived.contacts);
  write_imu(arrived.imus);
  if (link_) pace_.look(tick, link_->now_ns(), "the hardware");
}

void PlantRelay::take_joints(const Tick& tick, const std::vector<msg::HardwareJointState>& samples) {
  const msg::HardwareJointState* newest = nullptr;
  for (const auto& sample : samples) {
    const std::vector<double> before_rad = state_.hardware.angles_rad;
    if (const std::string why = judge_.judge(sample, tick.index, state_.hardware); !why.empty()) {
      refuse(why);
      if (!state_.following) HardwareJudge::forget(state_.hardware);
      continue;
    }
    newest = &sample;
    if (!before_rad.empty()) watch_motion(before_rad);
  }
  if (!newest) return lose(tick);
  // One sample proves little: a number or a stamp that never changes is acceptable once.
  if (!state_.following && state_.hardware.accepted < kSamplesInARow) return;
  const double elapsed_s = tick.period_s();
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    state_.angles_rad[i] = newest->position_rad[i];
    state_.velocities_rad_s[i] = newest->velocity_rad_s[i];
    state_.torques_nm[i] +=
        (newest->torque_nm[i] - state_.torques_nm[i]) * elapsed_s / (robot_.torque_filter_s + elapsed_s);
  }
  if (!state_.following) {
    if (state_.measured) wiring_.count_refusal("hardware: is back, and its posture is known again");
    gate_.forget_posture();
    state_.following = true;
    state_.measured = true;
    state_.obstacle.clear();
  }
  const std::string obstacle = obstacle_of(*newest);
  if (obstacle == state_.obstacle) return;
  if (!obstacle.empty()) refuse(obstacle);
  gate_.begin_at_posture();
  state_.obstacle = obstacle;
}

void PlantRelay::lose(const Tick& tick) {
  if (!state_.following || tick.index - state_.hardware.accepted_tick < config_.lost_after_ticks) return;
  const auto silent_ticks = tick.index - state_.hardware.accepted_tick;
  wiring_.count_refusal(fmt::format(
      "hardware: lost, no acceptable joint state for {} ticks; the robot holds until one "
      "arrives{}{}",
      silent_ticks, last_refusal_.empty() ? "" : " (last refusal: ", last_refusal_.empty() ? "" : last_refusal_ + ")"));
  state_.following = false;
  state_.frozen_ticks = 0;
  std::fill(state_.velocities_rad_s.begin(), state_.velocities_rad_s.end(), 0.0);
  HardwareJudge::forget(state_.hardware);
}

std::string PlantRelay::device_status() const {
  if (!state_.following) return "no process drives the joints";
  return state_.obstacle.empty() ? fmt::format("session {:x} drives the joints", state_.hardware.session)
                                 : state_.obstacle;
}

std::string PlantRelay::obstacle_of(const msg::HardwareJointState& sample) const {
  if (const std::string fault = printable(text_of(sample.fault)); !fault.empty()) return "hardware: fault: " + fault;
  const auto patience = static_cast<std::uint64_t>(config_.unconfirmed_after_ticks);
  const bool confirms = sample.command_session == state_.session && sample.command_number + patience >= state_.sent;
  if (state_.sent > patience && !confirms)
    return fmt::format(
        "hardware: confirms no command: command_session and command_number are {:x} and {}, accepted {:x} and one of "
        "the last {} up to the newest command: does it read hardware/joint_command, and accept a new session?",
        sample.command_session, sample.command_number, state_.session, patience);
  if (sample.holding && confirms) return "hardware: holds the posture by itself";
  return {};
}

void PlantRelay::watch_motion(const std::vector<double>& before_rad) {
  const auto& setpoints = gate_.state().setpoints;
  bool should_move = false;
  const bool follows = gate_.state().mode == GateMode::kObeying && !gate_.state().torque;  // a torque need not move
  if (follows && state_.obstacle.empty() && setpoints.size() == before_rad.size()) {
    for (std::size_t i = 0; i < before_rad.size(); ++i) {
      const double error_rad = std::abs(setpoints[i].position_rad - before_rad[i]);
      should_move = should_move || (error_rad > config_.frozen_error_rad && setpoints[i].torque_limit_nm > 0.0);
    }
  }
  if (!should_move || before_rad != state_.hardware.angles_rad) {
    state_.frozen_ticks = 0;
    return;
  }
  if (++state_.frozen_ticks != config_.frozen_after_ticks) return;
  refuse(fmt::format("hardware: is frozen: no measured angle has changed for {} samples although a joint should move",
                     state_.frozen_ticks));
  gate_.stop("hardware_frozen");
}

void PlantRelay::write_joints() {
  msg::JointState state{};
  state.joint_count = static_cast<std::uint16_t>(robot_.joints.size());
  std::copy(state_.angles_rad.begin(), state_.angles_rad.end(), state.position_rad);
  std::copy(state_.velocities_rad_s.begin(), state_.velocities_rad_s.end(), state.velocity_rad_s);
  std::copy(state_.torques_nm.begin(), state_.torques_nm.end(), state.torque_nm);
  joint_state_.write(state);
}

void PlantRelay::write_contacts(const std::vector<msg::HardwareContactState>& samples) {
  msg::ContactState contacts{};  // module_count 0: the robot has no sensors, or they are silent
  for (const auto& sample : samples) {
    if (!state_.following) break;
    if (const std::string why = judge_.judge(sample, state_.hardware); !why.empty()) {
      refuse(why);
      continue;
    }
    contacts.module_count = sample.module_count;
    contacts.contact_count = sample.contact_count;
    std::copy(std::begin(sample.force_n), std::end(sample.force_n), contacts.force_n);
    std::copy(std::begin(sample.torque_nm), std::end(sample.torque_nm), contacts.torque_nm);
    std::copy(std::begin(sample.contacts), std::end(sample.contacts), contacts.contacts);
  }
  contact_state_.write(contacts);
}

void PlantRelay::write_imu(const std::vector<msg::HardwareImuState>& samples) {
  const msg::HardwareImuState* newest = nullptr;
  for (const auto& sample : samples) {
    if (!state_.following) break;
    if (const std::string why = judge_.judge(sample, state_.hardware); !why.empty()) refuse(why);
    else newest = &sample;
  }
  if (!newest) return;
  msg::ImuState imu{};
  imu.orientation = newest->orientation;
  imu.angular_velocity_rad_s = newest->angular_velocity_rad_s;
  imu.linear_acceleration_m_s2 = newest->linear_acceleration_m_s2;
  imu_state_.write(imu);
}

void PlantRelay::step(const Tick& tick) {
  if (!state_.following) return;  // without commands the process holds by itself
  send(gate_.setpoints(tick, {state_.angles_rad, state_.velocities_rad_s}, !state_.obstacle.empty()), tick);
}

void PlantRelay::send(const std::vector<JointSetpoint>& setpoints, const Tick& tick) {
  if (state_.session == 0) state_.session = session_of(tick, state_.starts);
  msg::HardwareJointCommand command{};
  command.session = state_.session;
  command.sequence_number = ++state_.sent;
  command.period_ns = tick.period_ns;
  command.mode = servo_mode(gate_.state());
  command.joint_count = static_cast<std::uint16_t>(setpoints.size());
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    command.position_rad[i] = setpoints[i].position_rad;
    command.velocity_rad_s[i] = setpoints[i].velocity_rad_s;
    command.torque_limit_nm[i] = setpoints[i].torque_limit_nm;
    command.torque_nm[i] = setpoints[i].torque_nm;
  }
  if (link_) link_->send(command);
}

std::string PlantRelay::save() const { return save_bytes(gate_, state_); }

void PlantRelay::load(const std::string& bytes) {
  load_bytes(bytes, gate_, state_);
  // The joints may have moved meanwhile, and the commands of this process are those of a new session.
  continued_ = true;
  state_.following = false;
  HardwareJudge::forget(state_.hardware);
  ++state_.starts;
  state_.session = 0;
  state_.sent = 0;
}

ComponentFactory make_plant_relay_factory() {
  return make_factory<PlantRelay, PlantRelayConfig>("plant_relay", "components/plant_relay/plant_relay.yaml");
}

}  // namespace constrictor
