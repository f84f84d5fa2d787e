// The safety gate in front of the actuators: the last line between anybody's mistake and the servos. At control's output, and
// again in the plant: the simulated one, or a driver of real servos. Pure: time is an argument, counted in ticks.
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

/// Why a command was not obeyed.
enum class GateRefusal : std::uint8_t {
  kNone,
  kWrongEpoch,    ///< of another run or another epoch of it
  kFromFuture,    ///< written after the present tick
  kStale,         ///< older than its limit when it arrived
  kUnknownMode,
  kWrongCount,    ///< another number of joints than the robot has
  kNotFinite,
  kBeyondLimits,  ///< a position beyond the joint's limits, or a negative torque limit
  kCount,
};
/// For people.
[[nodiscard]] const char* text_of(GateRefusal refusal);

/// What the joints do.
enum class GateMode : std::uint8_t {
  kObeying,
  kHolding,  ///< nobody commands, or the command is stale or refused: the posture is held
  kRelaxed,  ///< after a long silence, or because that was asked for: no torque
  kStopped,  ///< emergency stop: the posture is held, however long
};

/// What authority demands of the joints, whatever the commands say.
enum class GateOrder : std::uint8_t {
  kObey,
  kHold,  ///< authority was given back or its holder died: hold the posture until somebody takes it up
  kStop,  ///< emergency stop, latched by the input layer
};

/// A command as it arrived. Modes are kServoFollow and kServoRelaxed of plant.idl.
struct GateCommand {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::int64_t tick = 0;             ///< of the step that wrote it
  std::uint64_t sequence_number = 0; ///< a message seen again is not refused, and counted, again
  std::uint8_t mode = 0;
  std::span<const double> position_rad;
  std::span<const double> velocity_rad_s;
  std::span<const double> torque_limit_nm;
};

/// The present.
struct GateInstant {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::int64_t tick = 0;
};

struct GateLimits {
  std::int64_t stale_after_ticks = 5;    ///< a command older than this is not obeyed: the posture is held
  std::int64_t relax_after_ticks = 250;  ///< ... and after this long without an acceptable command the joints relax
};

/// `authority` is said every 50 ticks. Said longer ago than this, it is nobody's: whoever says it hangs or has gone, which counts at
/// real-time pace, where nobody is waited for. An emergency stop stays.
inline constexpr std::int64_t kAuthoritySilentAfter_ticks = 150;
[[nodiscard]] constexpr std::uint8_t level_in_force(std::uint8_t level, std::int64_t age_ticks) {
  return age_ticks > kAuthoritySilentAfter_ticks ? std::uint8_t{0} : level;
}

/// Everything the gate remembers. Serialisable.
struct GateState {
  GateMode mode = GateMode::kHolding;
  bool started = false;        ///< `setpoints` are in force
  bool accepted = false;       ///< a command was accepted since the last setpoints()
  bool relax = false;          ///< ... and asks for relaxed joints
  bool commanded = false;      ///< somebody has had authority
  std::uint8_t level = 0;      ///< of whom is obeyed; 0: nobody, or stopped
  std::string source;          ///< ... and who that is
  bool take_over = false;      ///< somebody else has taken over, and no command was obeyed since
  std::int64_t silent_ticks = 0;
  std::uint64_t last_sequence = 0;             ///< of the newest message that was judged
  std::vector<JointSetpoint> offered;
  std::vector<JointSetpoint> setpoints;        ///< in force
  std::array<std::uint64_t, static_cast<std::size_t>(GateRefusal::kCount)> refused{};  ///< messages, by reason

  template <class Archive>
  void serialize(Archive& archive) {
    archive(mode, started, accepted, relax, commanded, level, source, take_over, silent_ticks, last_sequence, offered, setpoints);
    for (std::uint64_t& count : refused) archive(count);
  }
};

/// Messages refused for any reason.
[[nodiscard]] std::uint64_t refused_count(const GateState& state);
/// The reason with its count, for people: "stale when it came (3 so far)".
[[nodiscard]] std::string text_of(GateRefusal refusal, const GateState& state);

class SafetyGate {
 public:
  /// Limits of position, rate and torque are the robot file's.
  SafetyGate(const RobotModel& robot, GateLimits limits);

  /// A command as it arrived. It is accepted or refused as a whole; a refused one is counted by its reason, once. One that was
  /// acceptable when it came and has grown stale since is silence, not a mistake: kStale, uncounted.
  GateRefusal offer(const GateCommand& command, const GateInstant& now, GateState& state) const;

  /// What the topic `authority` demands. `level`: kAuthority... of mission.idl; `source`: who has it (a zero may end it). Nobody's
  /// authority (0) is a reason to hold only after somebody had it: at the start of a run control holds the posture by itself. Another
  /// level or source than was obeyed before, also after a hold or a stop, is a take-over; the first of a run is not.
  static GateOrder order_of(bool emergency_stop, std::uint8_t level, std::span<const char> source, GateState& state);

  /// Setpoints for the `dt_s` that begin, after at most one offer() since the previous call. The first ones are the measured
  /// posture, and from there on no setpoint moves faster than its joint can. The first command that is obeyed after a take-over
  /// begins anew at the measured posture (a joint without a finite measurement: at its setpoint). Held is the last setpoint of each
  /// joint where it agrees with the measured angle, else the measured angle, with the torque limits in force: what was grasped
  /// stays so.
  const std::vector<JointSetpoint>& setpoints(std::span<const double> measured_rad, GateOrder order, double dt_s, GateState& state) const;

  [[nodiscard]] static std::uint64_t refused(const GateState& state, GateRefusal reason) {
    return state.refused[static_cast<std::size_t>(reason)];
  }

 private:
  [[nodiscard]] GateRefusal judge(const GateCommand& command, const GateInstant& now) const;
  void follow(std::span<const double> measured_rad, double dt_s, GateState& state) const;
  void hold(std::span<const double> measured_rad, GateState& state) const;
  void relax(std::span<const double> measured_rad, GateState& state) const;

  std::vector<JointModel> joints_;
  GateLimits limits_;
};

}  // namespace constrictor
