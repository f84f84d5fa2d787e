#include "plant/plant_gate.hpp"

#include <utility>

#include "robot/gate_messages.hpp"

namespace constrictor {

PlantGate::PlantGate(Wiring& wiring, const RobotModel& robot, GateLimits limits,
                     std::vector<std::int64_t> planned_stops)
    : wiring_(wiring),
      gate_(robot, limits),
      command_(wiring.latest(topics::kJointCommand)),
      authority_(wiring.latest(topics::kAuthority)),
      stop_(wiring, std::move(planned_stops)) {}

void PlantGate::stop(const std::string& source) {
  if (const auto orders = wiring_.stop_orders()) orders->add(source);
}

const std::vector<JointSetpoint>& PlantGate::setpoints(const Tick& tick, const MeasuredJoints& measured, bool hold) {
  if (command_) {
    const std::uint64_t refused_before = refused_count(state_);
    const GateRefusal refusal =
        gate_.offer(gate_command(*command_, command_->header), {tick.run_id, tick.epoch, tick.index}, state_);
    if (refused_count(state_) != refused_before) wiring_.count_refusal("joint_command: " + text_of(refusal, state_));
  }
  GateOrder order = stop_.in_force() ? SafetyGate::order_of(true, msg::kAuthorityNone, {}, state_)
                                     : gate_order(authority_.get(), authority_ ? authority_.age_ticks() : 0, state_);
  if (hold && order == GateOrder::kObey) order = GateOrder::kHold;
  return gate_.setpoints(measured, order, tick.period_s(), state_);
}

}  // namespace constrictor
