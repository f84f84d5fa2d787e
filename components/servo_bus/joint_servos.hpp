// The servos of all joints: start-up, one round of reading and one of writing in each tick, and what to do when a servo
// is lost, shut down or locked. It accesses only the buses, and reads no clock.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "robot/joint_limits.hpp"
#include "servo_bus/bus_ports.hpp"
#include "servo_bus/servo_bus_config.hpp"

namespace constrictor {

/// The measurements of a servo, and those of its joint.
struct JointReading {
  double angle_rad = 0.0;
  double rate_rad_s = 0.0;
  double torque_nm = 0.0;  ///< not filtered
  bool torque_on = false;
  int temperature_c = 0;
  double voltage_v = 0.0;
  std::uint8_t hardware_errors = 0;
  std::int64_t watchdog = 0;  ///< kWatchdogTripped: the servo has stopped and locked its goals
};

enum class ServoState : std::uint8_t {
  kLost,      ///< it does not answer, or it was not started yet
  kReady,     ///< it is configured and answers
  kShutDown,  ///< it answers, but has switched its torque off because of a hardware error
};

class JointServos {
 public:
  /// `ports` must outlive this object.
  JointServos(const dynamixel::BusPlan& plan, const RobotModel& robot, const ServoBusConfig& config, BusPorts& ports);

  /// Configures all servos and reads the posture. Moves nothing: a servo without torque gets its present position as
  /// its goal before its torque can be switched on; a servo whose watchdog has tripped stays as it is. Servos that are
  /// silent are asked again for `patience_s`: their power may have been switched on a moment ago. Returns the servos
  /// that cannot be started, one line each with the reason; empty: all are ready.
  [[nodiscard]] std::vector<std::string> start(double patience_s);
  /// Reads all servos, and tries to bring back one that is lost.
  void measure();
  /// Sends the setpoints, one for each joint. A torque limit of 0 switches the torque of a joint off. A joint in torque
  /// mode gets the current of its torque as its limit, and a goal ahead of it in the direction of the torque.
  void command(std::span<const JointSetpoint> setpoints);
  /// Switches the torque of all servos off, unless `torque_off` is false, and then their watchdogs: a watchdog that is
  /// armed would trip in the silence that follows, and stop the next run. A servo that keeps its torque and whose
  /// watchdog has tripped stays locked, because it might move. Returns the servos that have not confirmed it, one line
  /// each.
  [[nodiscard]] std::vector<std::string> release(bool torque_off);

  [[nodiscard]] const JointReading& reading(std::size_t joint) const { return joints_[joint].reading; }
  [[nodiscard]] ServoState state(std::size_t joint) const { return joints_[joint].state; }
  [[nodiscard]] std::size_t count() const { return joints_.size(); }
  /// "servo 8 of joint 7 at /dev/ttyUSB0"
  [[nodiscard]] std::string name_of(std::size_t joint) const;
  /// Every joint can follow commands.
  [[nodiscard]] bool complete() const;
  /// The watchdog of a servo has tripped: it executes no command until unlock().
  [[nodiscard]] bool locked() const;
  /// Clears the watchdogs; the present positions become the goals, so that nothing moves.
  void unlock();
  /// Why the servos at a port are asked with Sync Read, and not with Fast Sync Read; empty: they are not.
  [[nodiscard]] std::string slow_because(std::size_t port) const;
  /// The events since the last call.
  [[nodiscard]] std::vector<BusNews> take_news() { return std::exchange(news_, {}); }

 private:
  struct Joint {
    JointModel limits;
    dynamixel::JointServo servo;
    ServoState state = ServoState::kLost;
    JointReading reading;
    std::int64_t current_limit = 0;  ///< largest goal: of the register, and of servo.load_share
    int firmware = 0;                ///< 0: not known
    int misses = 0;                  ///< rounds without an answer
    int reboots = 0;
    bool seen = false;    ///< in this round
    bool exerts = false;  ///< its last goal was one of torque mode
    std::uint8_t reported_errors = 0;
    bool reported_lock = false;
    std::string reported_failure;  ///< why it could not be brought back
  };

  /// The block of goals of one servo, in its units.
  struct Goal {
    std::int64_t current = 0;
    std::int64_t profile_ms = 0;  ///< 0: the servo goes to the goal at once
    std::int64_t steps = 0;
  };

  [[nodiscard]] Goal goal_of(const Joint& joint, const JointSetpoint& setpoint) const;
  /// The goal that lets the servo exert its whole goal current: as far ahead as the joint can come in one tick, at most
  /// its limit.
  [[nodiscard]] double torque_goal_rad(const Joint& joint, double torque_nm) const;
  [[nodiscard]] dynamixel::Bytes ids_at(std::size_t port, ServoState state, bool unseen_only = false) const;
  void read_port(std::size_t port);
  void take(Joint& joint, const serial::Answer& answer);
  void judge(std::size_t index);
  void lose(std::size_t index, const std::string& why);
  void look_for_one_lost();
  /// Why a servo cannot be started.
  struct StartProblem {
    std::string why;         ///< empty: it is ready
    bool is_silent = false;  ///< it has not answered a question: a later attempt may succeed
  };
  [[nodiscard]] StartProblem bring_up(serial::BusMaster& bus, Joint& joint);
  void configure(serial::BusMaster& bus, const Joint& joint, bool tripped);
  /// Writes 0 to a register of these joints, at all ports at once, until each servo has confirmed it or has been asked
  /// three times. Returns the joints whose servos have not.
  [[nodiscard]] std::vector<std::size_t> clear(const dynamixel::Register& reg, std::vector<std::size_t> joints);
  void make_blocks();

  const dynamixel::BusPlan& plan_;
  const ServoBusConfig& config_;
  BusPorts& ports_;
  std::vector<Joint> joints_;
  std::vector<bool> slow_;         ///< by port: the servos are asked with Sync Read
  std::vector<bool> reversed_;     ///< by port: the servos are asked from the tail on
  dynamixel::Bytes pointers_;      ///< values of the registers indirect_address_1 and following
  std::uint16_t goal_block_ = 0;   ///< address of the goals behind indirect registers
  std::uint16_t state_block_ = 0;  ///< the same of the measurements
  std::uint16_t goal_bytes_ = 0;
  std::uint16_t state_bytes_ = 0;
  std::size_t next_lost_ = 0;  ///< joint at which the search for a lost servo goes on
  std::vector<BusNews> news_;
};

}  // namespace constrictor
