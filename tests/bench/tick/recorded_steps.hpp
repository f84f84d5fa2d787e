// Steps of the physics that a world has really done, so that each part of a step can be repeated alone.
#pragma once

#include <utility>
#include <vector>

#include "sim/world/chain_dynamics.hpp"
#include "sim/world/contact_finder.hpp"
#include "sim/world/world.hpp"

namespace constrictor::bench {

/// The parts of World::step with the engine `chain`, in their order.
enum class Part { kServos, kGroundTorques, kCollision, kBuilding, kSolution, kIntegration, kContactSums, kEnd };

/// One step, which can be repeated part by part.
class RecordedStep {
 public:
  /// `before`, `drives`: the memory of the engine and the drives of the joints before the step; `after`: the memory
  /// after it.
  RecordedStep(std::vector<double> before, std::vector<JointDrive> drives, std::vector<double> after)
      : before_(std::move(before)), recorded_drives_(std::move(drives)), after_(std::move(after)) {}

  /// Goes back to the beginning of the step.
  void begin(ChainDynamics& engine);
  /// Does the parts before `end`, from the first one on.
  void run_until(Part end, const World& world, ContactFinder& finder, ChainDynamics& engine);
  /// Does one part of the step. The parts must be done in their order.
  void run(Part part, const World& world, ContactFinder& finder, ChainDynamics& engine);
  /// Whether the engine has the same state as the recorded one after the step, bit for bit.
  [[nodiscard]] bool same_end(const ChainDynamics& engine) const { return engine.save() == after_; }

 private:
  std::vector<double> before_;
  std::vector<JointDrive> recorded_drives_;
  std::vector<double> after_;
  std::vector<JointDrive> drives_;
  std::vector<ServoRow> rows_;
  ContactSet contacts_;
};

/// The steps of some ticks, more than a cycle of the gait, in the scene of the case study.
class RecordedTicks {
 public:
  static constexpr int kSteps = 4;  ///< of a tick

  RecordedTicks();

  [[nodiscard]] std::size_t size() const { return steps_.size() / kSteps; }
  /// In each step of a tick, does the parts before `part`, and then this part. Returns the time [s] of this part alone,
  /// in all steps of the tick: the median of five measurements, so that it does not matter if another program takes the
  /// processor in one of them.
  [[nodiscard]] double measure(std::size_t tick, Part part);
  /// Whether the parts, done one after the other, have the same result as the steps of the world, bit for bit.
  [[nodiscard]] bool exact();
  /// Iterations of Newton's method in the steps of all ticks.
  [[nodiscard]] double iterations_per_tick();
  [[nodiscard]] const World& world() const { return world_; }

 private:
  /// One measurement.
  double run(std::size_t tick, Part part);

  RobotModel robot_;
  World world_;
  ContactFinder finder_;
  ChainDynamics engine_;
  std::vector<RecordedStep> steps_;
};

/// The scene of the case study with seed 1, and the robot of most runs.
[[nodiscard]] Scenario case_study_scene(const RobotModel& robot);

}  // namespace constrictor::bench
