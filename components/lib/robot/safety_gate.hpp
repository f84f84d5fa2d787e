// The safety gate in front of the servos: the last check of every command. It stands at the output of control and again
// in the plant (the simulated one, or a driver of real servos). It is pure: time is an argument, counted in ticks.
#pragma once

#include <array>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "robot/joint_limits.hpp"

namespace constrictor {

/// Why a command was refused.
enum class GateRefusal : std::uint8_t {
  kNone,
  kWrongEpoch,  ///< of another run, or of another epoch of this run
  kFromFuture,  ///< written after the present tick
  kStale,       ///< older than the limit on its arrival
  kUnknownMode,
  kWrongCount,  ///< the robot has another number of joints
  kNotFinite,
  kBeyondLimits,  ///< a position beyond the joint's limits, or a negative torque limit
  kNoTorqueMode,  ///< the command demands torques of a plant that cannot exert them
  kCount,
};
/// The reason in words, for people.
[[nodiscard]] const char* text_of(GateRefusal refusal);

/// The behaviour of the joints.
enum class GateMode : std::uint8_t {
  kObeying,
  kHolding,  ///< the posture is held: no source commands, or the command is stale or refused
  kRelaxed,  ///< no torque: on command, or after a long time without an acceptable command
  kStopped,  ///< emergency stop: the posture is held until the stop is cleared
};

/// The order that follows from the authority. It overrides the commands.
enum class GateOrder : std::uint8_t {
  kObey,
  kHold,  ///< the source released authority or died: the posture is held until a source takes authority
  kStop,  ///< emergency stop, which `input` latches
};

/// A command as it arrived. `mode`: kServo... of plant.idl.
struct GateCommand {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::int64_t tick = 0;              ///< tick of the step that wrote it
  std::uint64_t sequence_number = 0;  ///< a message that is offered again is counted once
  std::uint8_t mode = 0;
  std::span<const double> position_rad;
  std::span<const double> velocity_rad_s;
  std::span<const double> torque_limit_nm;
  std::span<const double> torque_nm{};  ///< used in torque mode only
};

/// The measurements of the joints; one entry for each joint.
struct MeasuredJoints {
  std::span<const double> angle_rad;
  std::span<const double> rate_rad_s{};  ///< used in torque mode only; empty: not known, and no torque is exerted
};

/// The present instant.
struct GateInstant {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::int64_t tick = 0;
};

struct GateLimits {
  std::int64_t stale_after_ticks = 5;    ///< an older command is not obeyed: the posture is held
  std::int64_t relax_after_ticks = 250;  ///< after this time without an acceptable command the joints relax
  bool torque_mode = true;               ///< the joints can exert torques on command
};

/// `input` publishes authority every 50 ticks. If the newest message is older than this limit, `input` hangs or is
/// gone, and no source has authority. (This matters at real-time pace, where the run waits for no member.) An emergency
/// stop stays in force.
inline constexpr std::int64_t kAuthoritySilentAfter_ticks = 150;
[[nodiscard]] constexpr std::uint8_t level_in_force(std::uint8_t level, std::int64_t age_ticks) {
  return age_ticks > kAuthoritySilentAfter_ticks ? std::uint8_t{0} : level;
}

/// The memory of the gate. Serialisable.
struct GateState {
  GateMode mode = GateMode::kHolding;
  bool started = false;    ///< `setpoints` are in force
  bool accepted = false;   ///< a command has been accepted since the last setpoints()
  bool relax = false;      ///< that command demands relaxed joints
  bool torque = false;     ///< that command demands torques
  bool commanded = false;  ///< a source has had authority in this run
  std::uint8_t level = 0;  ///< authority level of the source that is obeyed; 0: none, or stopped
  std::string source;      ///< the source that is obeyed
  bool take_over = false;  ///< another source has taken over and no command has been obeyed since
  std::int64_t silent_ticks = 0;
  std::uint64_t last_sequence = 0;  ///< of the newest message that was offered
  std::vector<JointSetpoint> offered;
  std::vector<JointSetpoint> setpoints;  ///< in force
  std::array<std::uint64_t, static_cast<std::size_t>(GateRefusal::kCount)>
      refused{};  ///< number of refused messages, by reason

  template <class Archive>
  void serialize(Archive& archive) {
    archive(mode, started, accepted, relax, torque, commanded, level, source, take_over, silent_ticks, last_sequence,
            offered, setpoints);
    for (std::uint64_t& count : refused) archive(count);
  }
};

/// Number of messages refused for any reason.
[[nodiscard]] std::uint64_t refused_count(const GateState& state);
/// The reason with its count, for people: "stale on arrival (3 so far)".
[[nodiscard]] std::string text_of(GateRefusal refusal, const GateState& state);

/// Decides which commands the joints obey. README.md has the table of rules.
class SafetyGate {
 public:
  /// The limits of position, rate and torque are those of the robot file.
  SafetyGate(const RobotModel& robot, GateLimits limits);

  /// Offers a command, which is accepted or refused as a whole. A refused message is counted once, under its reason. A
  /// message that was acceptable on its arrival and has become stale since is kStale too, but it is not counted: that
  /// is silence, not a mistake.
  GateRefusal offer(const GateCommand& command, const GateInstant& now, GateState& state) const;

  /// The order that follows from `authority`. `level`: kAuthority... of mission.idl. `source`: the name of the source,
  /// which ends at the first zero. Level 0 (no source) demands a hold only after a source has had authority: at the
  /// start of a run control holds the posture by itself. A level or source that differs from the one that was obeyed
  /// last, also before a hold or a stop, is a takeover. The first source of a run takes nothing over.
  static GateOrder order_of(bool emergency_stop, std::uint8_t level, std::span<const char> source, GateState& state);

  /// The setpoints for the next `dt_s`. There may be at most one offer() between two calls. The first setpoints are the
  /// measured posture; afterwards no setpoint moves faster than its joint can. The first obeyed command after a
  /// takeover, or after torque mode, starts at the measured posture (a joint without a finite measurement: at its
  /// setpoint). A hold keeps the last setpoint of each joint where it agrees with the measured angle, and the measured
  /// angle elsewhere and after torque mode. It keeps the torque limits, so that a grasped object stays grasped. In
  /// torque mode each torque is at most the limit of the command and of the joint, and safe_torque_nm() of it.
  const std::vector<JointSetpoint>& setpoints(const MeasuredJoints& measured, GateOrder order, double dt_s,
                                              GateState& state) const;

  [[nodiscard]] static std::uint64_t refused(const GateState& state, GateRefusal reason) {
    return state.refused[static_cast<std::size_t>(reason)];
  }

 private:
  [[nodiscard]] GateRefusal judge(const GateCommand& command, const GateInstant& now) const;
  void follow(std::span<const double> measured_rad, double dt_s, GateState& state) const;
  void exert(const MeasuredJoints& measured, double dt_s, GateState& state) const;
  void hold(std::span<const double> measured_rad, GateState& state) const;
  void relax(std::span<const double> measured_rad, GateState& state) const;

  std::vector<JointModel> joints_;
  GateLimits limits_;
};

}  // namespace constrictor
