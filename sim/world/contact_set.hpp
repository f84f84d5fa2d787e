// The contacts of one world: makes ODE's contact joints in each step, and sums the forces on the robot's skin over a
// tick.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <vector>

#include "sim/world/collision.hpp"
#include "sim/world/ode_handles.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

enum class Touched : std::uint8_t { kGround = 0, kSelf = 1, kObject = 2, kObstacle = 3 };  // numbers of simulation.idl

/// A contact that a module feels. Vectors are in the module's frame; the force is the mean over the last advance().
struct ModuleContact {
  std::uint8_t module_index = 0;
  Touched touched = Touched::kGround;
  std::uint8_t touched_index = 0;  ///< index of the touched object, obstacle or module
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d normal{0.0, 0.0, 1.0};   ///< unit vector that points into the module
  Eigen::Vector3d force_n{0.0, 0.0, 0.0};  ///< on the module
};

/// Coulomb friction of a pair of bodies. The friction is isotropic if `direction` is null; `across` is then unused.
struct Friction {
  double along = 0.0;
  double across = 0.0;
  const Eigen::Vector3d* direction = nullptr;  ///< direction in which `along` acts, in W, perpendicular to the normal
};

class ContactSet {
 public:
  ContactSet(dWorldID world, const SolverSettings& settings);

  /// Call at the beginning of a tick: clears the sums of the previous tick.
  void begin_tick();
  /// Call at the beginning of each step: removes the contacts of the previous step.
  void begin_step();
  /// Adds a contact that no module feels. `second` is null for the ground and for obstacles.
  void add(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second);
  /// Adds a contact that module `module` (body `first`) feels. `feature` distinguishes several contacts of one pair.
  void add_felt(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second, std::uint8_t module,
                Touched touched, std::uint8_t index, std::uint8_t feature);
  /// Call after the solver: adds the forces of the step to the sums of the tick.
  void collect();
  /// [W] power that the felt contacts of the last step give to the bodies; negative, because friction takes energy.
  [[nodiscard]] double felt_power_w() const;
  /// Mean contacts of the tick so far, in the order of falling force.
  [[nodiscard]] std::vector<ModuleContact> felt() const;

  /// The sums of the last tick. The joints of the last step are not part of it: begin_step() removes them.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sums_, steps_);
  }

 private:
  struct Record {  // a felt contact joint of the present step
    dBodyID first;
    dBodyID second;
    std::uint32_t key;
    TouchPoint touch;
  };
  struct Sum {
    std::uint32_t key;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // weighted by force
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double weight = 0.0;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(key, weight);
      for (Eigen::Vector3d* v : {&position, &normal, &force}) archive(v->x(), v->y(), v->z());
    }
  };

  [[nodiscard]] Eigen::Vector3d sliding_direction(const TouchPoint& touch, dBodyID first, dBodyID second) const;
  dJointID make(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second);
  void sum_up(std::uint32_t key, dBodyID body, const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
              const dReal* force);

  dWorldID world_;
  double step_s_;
  OdeJointGroup group_;
  dSurfaceParameters surface_{};
  std::vector<Record> records_;
  std::vector<dJointFeedback> feedback_;  // one for each record; ODE keeps pointers into it
  std::vector<Sum> sums_;                 // ordered by key
  int steps_ = 0;
};

}  // namespace constrictor
