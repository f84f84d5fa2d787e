#include "control/control.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "constrictor/text.hpp"
#include "control/control_fit.hpp"
#include "robot/gate_messages.hpp"

namespace constrictor {
namespace {

constexpr double kLongestPeriod_s = 10.0;  // of MotionStatus.period_s: a body that stands does not sway

}  // namespace

Control::Control(Wiring& wiring, const Setup& setup, MethodRegistry methods)
    : TunableComponent(wiring,
                       control_fitted_to(load_robot(setup.robot_file), load_configuration<ControlConfig>(setup)),
                       topics::kControlParameters),
      robot_(load_robot(setup.robot_file)),
      chain_(robot_),
      limiter_(robot_, config_.speed_share, config_.lead_s),
      gate_(robot_, {0, config_.relax_after_ticks}),
      registry_(std::move(methods)) {}

const ControlMethod* Control::method_for(const msg::DesiredTrajectory& desired) const {
  const ControlMethod* method = registry_.find(method_of(desired.motion, config_));
  if (method && method->accepts(desired, chain_)) return method;
  method = drives(desired.motion) ? registry_.find(drive_methods().front()) : nullptr;
  return method && method->accepts(desired, chain_) ? method : nullptr;
}

Control::Choice Control::choose() const {
  Choice choice;
  const char* fallback = "hold";
  if (trajectory_in_) {
    choice.desired = *trajectory_in_;
    choice.method = method_for(choice.desired);
    choice.known = choice.method != nullptr;
    if (trajectory_in_.age_ticks() > config_.relax_after_ticks) fallback = "relax";
    if (choice.known && trajectory_in_.age_ticks() <= config_.hold_after_ticks) return choice;
  }
  msg::DesiredTrajectory& desired = choice.desired;
  desired.shape_count = std::min<std::uint16_t>(desired.shape_count, static_cast<std::uint16_t>(chain_.joint_count()));
  desired.point_count = 0;
  desired.speed_m_s = 0.0;
  choice.method = registry_.find(fallback);
  return choice;
}

Perceived Control::perceived() const {
  return {body_.contacts.get(), imu_in_.get(),     field_.line.get(),
          field_.objects.get(), field_.pose.get(), field_.map.get()};
}

void Control::step(const Tick& tick) {
  parameters_.step(tick, state_.parameters);
  if (!body_.joints) return;
  if (body_.joints->joint_count != robot_.joints.size()) {
    if (body_.joints.fresh()) {
      wiring_.count_refusal("joint_state.joint_count: found " + std::to_string(body_.joints->joint_count) +
                            ", accepted " + std::to_string(robot_.joints.size()));
    }
    return;
  }
  JointArray measured_rad{}, rate_rad_s{}, torque_nm{}, exerted_nm{};
  const std::size_t count = robot_.joints.size();
  std::copy_n(body_.joints->position_rad, count, measured_rad.begin());
  std::copy_n(body_.joints->velocity_rad_s, count, rate_rad_s.begin());
  std::copy_n(body_.joints->torque_nm, count, torque_nm.begin());
  for (std::size_t j = 0; j < state_.gate.setpoints.size(); ++j) {
    exerted_nm[j] = state_.gate.setpoints[j].torque_nm;
    // Torques move the joints meanwhile, so that the next motion begins where they are now.
    if (state_.gate.setpoints[j].torque_mode) state_.limiter.position_rad[j] = measured_rad[j];
  }
  if (!state_.limiter.started) state_.limiter.position_rad = measured_rad;

  const Choice choice = choose();
  const msg::DesiredTrajectory& desired = choice.desired;
  const std::string method(choice.method->name());
  const Gait gait = gait_of(desired, config_);
  const JointArray commanded_rad = state_.limiter.position_rad;
  const MethodInput input{robot_,    chain_,        config_,     desired,     gait,       measured_rad,
                          torque_nm, commanded_rad, tick.dt_s(), perceived(), rate_rad_s, exerted_nm};
  if (state_.method != method || state_.motion_id != desired.motion_id) {
    state_.body.scratch = {};
    state_.body.sliding = {};
    choice.method->start(input, state_.body);
    state_.method = method;
    state_.motion_id = desired.motion_id;
  }
  Setpoints setpoints;
  setpoints.position_rad = commanded_rad;
  for (std::size_t j = 0; j < count; ++j) setpoints.torque_limit_nm[j] = robot_.joints[j].max_torque_nm;
  const MethodProgress progress = choice.method->step(input, state_.body, setpoints);
  const bool relaxed = method == "relax";
  msg::JointCommand wanted = relaxed ? limiter_.relax(measured_rad, state_.limiter)
                                     : limiter_.limit(setpoints, measured_rad, tick.dt_s(), state_.limiter);
  if (relaxed) wanted.mode = msg::kServoRelaxed;
  command_out_.write(gated(wanted, measured_rad, rate_rad_s, tick));

  msg::MotionStatus status{};
  set_text(status.method, method);
  status.motion_id = desired.motion_id;
  status.accepted = choice.known;
  status.done = choice.known && progress.done;
  status.progress = progress.progress;
  status.phase_rad = state_.body.wave.phase_rad;
  status.period_s = std::min(kLongestPeriod_s, 1.0 / std::abs(gait.frequency_hz));
  status_out_.write(status);
}

msg::JointCommand Control::gated(const msg::JointCommand& wanted, const JointArray& measured_rad,
                                 const JointArray& rate_rad_s, const Tick& tick) {
  const std::size_t count = robot_.joints.size();
  const GateInstant now{tick.run_id, tick.epoch, tick.index};
  msg::Header header{};  // as the runtime will fill it in when the command is published
  header.run_id = now.run_id;
  header.epoch = now.epoch;
  header.tick = now.tick;
  header.sequence_number = static_cast<std::uint64_t>(tick.index) + 1;
  const GateRefusal refusal = gate_.offer(gate_command(wanted, header), now, state_.gate);
  if (refusal != GateRefusal::kNone)
    wiring_.count_refusal(std::string("joint_command of ") + state_.method + ": " + text_of(refusal, state_.gate));
  const GateOrder order = gate_order(authority_in_.get(), authority_in_ ? authority_in_.age_ticks() : 0, state_.gate);
  const MeasuredJoints measured{std::span(measured_rad).first(count), std::span(rate_rad_s).first(count)};
  const auto& setpoints = gate_.setpoints(measured, order, tick.dt_s(), state_.gate);
  msg::JointCommand command = wanted;
  command.mode = servo_mode(state_.gate);
  for (std::size_t j = 0; j < count; ++j) {
    command.position_rad[j] = setpoints[j].position_rad;
    command.velocity_rad_s[j] = setpoints[j].velocity_rad_s;
    command.torque_limit_nm[j] = setpoints[j].torque_limit_nm;
    command.torque_nm[j] = setpoints[j].torque_nm;
    // The motion after a hold begins at the held posture.
    if (state_.gate.mode != GateMode::kObeying) state_.limiter.position_rad[j] = setpoints[j].position_rad;
  }
  if (order != GateOrder::kObey) state_.method.clear();
  return command;
}

ComponentFactory make_control_factory() { return make_control_factory({}); }

ComponentFactory make_control_factory(std::vector<MethodMaker> more) {
  return {"control",
          [more = std::move(more)](Wiring& wiring, const Setup& setup) {
            MethodRegistry methods;
            for (const auto make : more) methods.add(make());
            return std::make_unique<Control>(wiring, setup, std::move(methods));
          },
          "components/control/control.yaml", describe_parameters<ControlConfig>};
}

}  // namespace constrictor
