// The commands that a plant obeys: it refuses wrong ones, holds, relaxes and stops.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "component/plant_stop.hpp"
#include "robot/safety_gate.hpp"

namespace constrictor {

/// A member of every plant. Call sample() in Plant::sample() and setpoints() in Plant::step().
class PlantGate {
 public:
  /// `planned_stops`: ticks at which the plant stops by itself, rising.
  PlantGate(Wiring& wiring, const RobotModel& robot, GateLimits limits, std::vector<std::int64_t> planned_stops = {});

  /// Latches the stops that have arrived, and publishes emergency_stop/state.
  void sample(const Tick& tick) { stop_.sample(tick); }
  /// Latches a stop of the plant itself with the next sample(); an operator must clear it.
  void stop(const std::string& source);
  /// Whether a stop is in force. Call it in Plant::step().
  [[nodiscard]] bool stopped() { return stop_.in_force(); }

  /// The setpoints of this tick for joints that move as `measured`. The plant's own stop comes first: it holds
  /// whatever `input` publishes, and also if `input` publishes nothing. `hold`: the posture is held although commands
  /// arrive, because the plant is not able to obey them.
  const std::vector<JointSetpoint>& setpoints(const Tick& tick, const MeasuredJoints& measured, bool hold = false);
  /// The next command that is obeyed begins at the measured posture, as after a takeover.
  void begin_at_posture() { state_.take_over = true; }
  /// The same, and a hold begins at the measured posture, too: the joints may have moved while they were not measured.
  void forget_posture() {
    state_.take_over = true;
    state_.started = false;
  }

  [[nodiscard]] const GateState& state() const { return state_; }
  [[nodiscard]] const PlantStopState& stop_state() const { return stop_.state(); }
  /// Gate and stops, as load() takes them.
  template <class Archive>
  void save(Archive& archive) const {
    archive(state_, stop_.state());
  }
  template <class Archive>
  void load(Archive& archive) {
    PlantStopState stop;
    archive(state_, stop);
    stop_.restore(stop);
  }

 private:
  Wiring& wiring_;
  SafetyGate gate_;
  GateState state_;
  Latest<msg::JointCommand> command_;
  Latest<msg::Authority> authority_;
  PlantStop stop_;
};

}  // namespace constrictor
