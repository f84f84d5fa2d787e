// The component `servo_bus`, the plant of a real robot: it drives the joints over serial buses and owns the time of the
// run, at real-time pace. It accesses only the buses.
#pragma once

#include "component/component.hpp"
#include "component/device_owner.hpp"
#include "log/news_log.hpp"
#include "plant/pace_check.hpp"
#include "plant/plant_gate.hpp"
#include "servo_bus/bus_record.hpp"
#include "servo_bus/joint_servos.hpp"
#include "servo_bus/sensor_boards.hpp"
#include "servo_bus/stuck_watch.hpp"

namespace constrictor {

class ServoBus final : public Plant, public DeviceOwner {
 public:
  /// Reads the robot, the configuration and the bus file; opens no port. Throws ConfigurationError. `open`: replaces
  /// the serial ports in tests.
  ServoBus(Wiring& wiring, const Setup& setup, const OpenPort& open = nullptr);
  /// As release_device().
  ~ServoBus() override;

  /// Reads the servos and the sensors. The first call opens the ports and starts the servos, which moves nothing.
  /// Throws ConfigurationError if a servo cannot be started, or if the run is faster than the clock.
  void sample(const Tick& tick) override;
  /// Obeys the commands. Holds the posture while a servo is missing, and while the servos are locked.
  void step(const Tick& tick) override;
  [[nodiscard]] std::int64_t period_ns() const override { return config_.period_ns(); }
  [[nodiscard]] std::string device_status() const override { return record_.summary(); }
  [[nodiscard]] bool needs_real_time() const override { return true; }
  /// Switches the torque off, if the configuration says so, and then the watchdogs.
  void release_device() override { release(); }
  /// Gate, stops and the last posture.
  [[nodiscard]] std::string save() const override;
  void load(const std::string& bytes) override;

  [[nodiscard]] const GateState& gate() const { return gate_.state(); }
  [[nodiscard]] const JointServos& servos() const { return servos_; }

 private:
  void start();
  void release();
  void measure();
  void write_joints(double elapsed_s);
  void report_news();
  /// Good news are no refusals.
  void report(const BusNews& news);
  void look_for_stuck_joints(std::span<const JointSetpoint> goals);

  Wiring& wiring_;
  Log log_;
  ServoBusConfig config_;
  RobotModel robot_;
  dynamixel::BusPlan plan_;
  BusPorts ports_;
  JointServos servos_;
  SensorBoards boards_;
  BusRecord record_;
  NewsLog news_log_;
  PlantGate gate_;
  StuckWatch stuck_;
  std::vector<double> angles_rad_, rates_rad_s_, torques_nm_;  ///< by joint; the torques are low-pass filtered
  bool started_ = false;
  bool released_ = false;
  bool continued_ = false;        ///< this process continues the run of its predecessor
  bool locked_ = false;           ///< a stop was ordered because a watchdog has tripped
  bool held_ = false;             ///< the posture is held because a servo is missing
  std::int64_t bus_time_ns_ = 0;  ///< that this tick has spent on the buses
  PaceCheck pace_;

  Output<msg::JointState> joint_state_ = wiring_.output(topics::kJointState);
  Output<msg::ContactState> contact_state_ = wiring_.output(topics::kContactState);
  Output<msg::ImuState> imu_state_ = wiring_.output(topics::kImuState);
};

ComponentFactory make_servo_bus_factory(const OpenPort& open = nullptr);

}  // namespace constrictor
