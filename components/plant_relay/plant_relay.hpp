// The component `plant_relay`, the plant of a robot whose joints a process outside the barrier drives. It owns the time
// of the run, at real-time pace, and keeps the safety gate; that process only measures and moves.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "component/device_owner.hpp"
#include "component/hardware_link.hpp"
#include "plant/pace_check.hpp"
#include "plant/plant_gate.hpp"
#include "plant_relay/hardware_judge.hpp"
#include "plant_relay/plant_relay_config.hpp"

namespace constrictor {

/// The memory of the relay, gate aside. Serialisable.
struct PlantRelayState {
  HardwareMemory hardware;
  std::vector<double> angles_rad, velocities_rad_s, torques_nm;  ///< one entry for each joint; torques are low-passed
  bool measured = false;                                         ///< there was a posture in this epoch
  bool following = false;                                        ///< the present posture is known
  std::uint64_t session = 0;                                     ///< of the commands; 0: none was sent
  std::uint64_t starts = 0;                                      ///< how often a process has continued this epoch
  std::uint64_t sent = 0;                                        ///< commands of this session
  std::int64_t frozen_ticks = 0;
  std::string obstacle;  ///< why the posture is held although commands arrive; empty: nothing
  template <class Archive>
  void serialize(Archive& archive) {
    archive(hardware, angles_rad, velocities_rad_s, torques_nm, measured, following, session, starts, sent,
            frozen_ticks, obstacle);
  }
};

class PlantRelay final : public Plant, public DeviceOwner {
 public:
  /// Throws ConfigurationError.
  PlantRelay(Wiring& wiring, const Setup& setup);

  /// Takes what the process has measured. Throws ConfigurationError if no acceptable posture arrives in time, or if the
  /// run is faster than the clock.
  void sample(const Tick& tick) override;
  /// Sends the setpoints of the gate; none while the posture is not known.
  void step(const Tick& tick) override;
  [[nodiscard]] std::int64_t period_ns() const override { return config_.period_ns(); }
  /// Whether the process that drives the joints is followed, and if it cannot obey, why.
  [[nodiscard]] std::string device_status() const override;
  [[nodiscard]] std::string save() const override;
  void load(const std::string& bytes) override;

  [[nodiscard]] const GateState& gate() const { return gate_.state(); }
  [[nodiscard]] const PlantRelayState& state() const { return state_; }

 private:
  void take_joints(const Tick& tick, const std::vector<msg::HardwareJointState>& samples);
  void write_contacts(const std::vector<msg::HardwareContactState>& samples);
  void write_imu(const std::vector<msg::HardwareImuState>& samples);
  void write_joints();
  void lose(const Tick& tick);
  void refuse(const std::string& reason);
  [[nodiscard]] std::string obstacle_of(const msg::HardwareJointState& sample) const;
  void watch_motion(const std::vector<double>& before_rad);
  void send(const std::vector<JointSetpoint>& setpoints, const Tick& tick);

  Wiring& wiring_;
  PlantRelayConfig config_;
  RobotModel robot_;
  HardwareJudge judge_;
  PlantGate gate_;
  PaceCheck pace_;
  std::shared_ptr<HardwareLink> link_;  ///< null: no process can be reached
  PlantRelayState state_;
  bool continued_ = false;  ///< this process continues the run of its predecessor
  std::string last_refusal_;

  Output<msg::JointState> joint_state_ = wiring_.output(topics::kJointState);
  Output<msg::ContactState> contact_state_ = wiring_.output(topics::kContactState);
  Output<msg::ImuState> imu_state_ = wiring_.output(topics::kImuState);
};

ComponentFactory make_plant_relay_factory();

}  // namespace constrictor
