// The contacts of one world: makes ODE's contact joints in each step and sums what the robot's skin feels over a tick.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/world/collision.hpp"
#include "sim/world/ode_handles.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

enum class Touched : std::uint8_t { kGround = 0, kSelf = 1, kObject = 2, kObstacle = 3 };  // numbers of simulation.idl

/// What a module feels at one point. Vectors in the module's frame; the force is the mean over the last advance().
struct ModuleContact {
  std::uint8_t module_index = 0;
  Touched touched = Touched::kGround;
  std::uint8_t touched_index = 0;  ///< of the object, obstacle or own module
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d normal{0.0, 0.0, 1.0};   ///< into the module
  Eigen::Vector3d force_n{0.0, 0.0, 0.0};  ///< on the module
};

/// Coulomb friction of a pair. Isotropic if `direction` is null.
struct Friction {
  double along = 0.0;
  double across = 0.0;
  const Eigen::Vector3d* direction = nullptr;  ///< of `along`, in W, perpendicular to the normal
};

class ContactSet {
 public:
  ContactSet(dWorldID world, const SolverSettings& settings);

  /// Forgets what was felt: a new tick begins.
  void begin_tick();
  /// Removes the contacts of the previous step.
  void begin_step();
  /// A contact between `first` and `second` (null: what never moves) that nobody feels.
  void add(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second);
  /// A contact that module `module` (body `first`) feels; `feature` tells apart several touches of one pair.
  void add_felt(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second, std::uint8_t module,
                Touched touched, std::uint8_t index, std::uint8_t feature);
  /// After the solver: adds the step's forces to the tick's sums.
  void collect();
  /// Mean contacts of the tick so far, the strongest first.
  [[nodiscard]] std::vector<ModuleContact> felt() const;

 private:
  struct Record {  // one contact joint of the present step that somebody feels
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
  };

  dJointID make(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second);
  void sum_up(std::uint32_t key, dBodyID body, const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
              const dReal* force);

  dWorldID world_;
  OdeJointGroup group_;
  dSurfaceParameters surface_{};
  std::vector<Record> records_;
  std::vector<dJointFeedback> feedback_;  // one for each record; ODE keeps pointers into it
  std::vector<Sum> sums_;                 // ordered by key
  int steps_ = 0;
};

}  // namespace constrictor
