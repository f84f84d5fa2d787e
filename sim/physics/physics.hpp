// The component `physics`, the simulated plant. It owns the joints and therefore the time of the run. It loads the
// robot and a scenario, obeys JointCommand, and publishes the measurements of the robot's sensors and, for the
// simulation only, ground truth.
#pragma once

#include "component/component.hpp"
#include "component/object_bounds.hpp"
#include "plant/plant_gate.hpp"
#include "sim/physics/perturbation_script.hpp"
#include "sim/physics/physics_config.hpp"
#include "sim/physics/sensors.hpp"

namespace constrictor {

class Physics final : public Plant, public ObjectSource, public SceneJudge {
 public:
  /// Reads the robot, the scenario with its seed, and the configuration. Throws ConfigurationError.
  Physics(Wiring& wiring, const Setup& setup);

  void sample(const Tick& tick) override;
  /// Holds the posture (SafetyGate) before the first command, when commands are stale or refused, and when no source
  /// has authority.
  void step(const Tick& tick) override;
  [[nodiscard]] std::int64_t period_ns() const override { return config_.period_ns(); }
  /// World, sensors, perturbations, gate and stops: about 10 kB for the case study.
  [[nodiscard]] std::string save() const override;
  void load(const std::string& bytes) override;

  [[nodiscard]] std::vector<DemandedObject> demanded_objects(const std::vector<std::uint8_t>& colours) const override;

  /// Warns of obstacles on the line.
  [[nodiscard]] CheckVerdict judge_scene() const override;

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const GateState& gate() const { return gate_.state(); }
  [[nodiscard]] const PlantStopState& stop() const { return gate_.stop_state(); }

 private:
  Physics(Wiring& wiring, const Setup& setup, const PhysicsConfig& config, const RobotModel& robot);
  Physics(Wiring& wiring, const Setup& setup, const PhysicsConfig& config, const RobotModel& robot,
          const Scenario& scenario);
  void obey(const Tick& tick);

  Wiring& wiring_;
  PhysicsConfig config_;
  World world_;
  Sensors sensors_;
  PerturbationScript perturbations_;
  PlantGate gate_;
  std::vector<double> angles_rad_, rates_rad_s_;  ///< one entry for each joint

  Output<msg::JointState> joint_state_ = wiring_.output(topics::kJointState);
  Output<msg::ContactState> contact_state_ = wiring_.output(topics::kContactState);
  Output<msg::ImuState> imu_state_ = wiring_.output(topics::kImuState);
  Output<msg::WorldState> world_state_ = wiring_.output(topics::kWorldState);
  Output<msg::TouchedState> touched_state_ = wiring_.output(topics::kTouchedState);
  Output<msg::SceneDescription> scene_ = wiring_.output(topics::kSceneDescription);
  bool scene_written_ = false;
};

ComponentFactory make_physics_factory();

}  // namespace constrictor
