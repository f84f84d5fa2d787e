// The contacts of one world: collects those of each step for the engine, and sums the forces on the robot's skin over a
// tick.
#pragma once

#include <Eigen/Core>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/world/collision.hpp"
#include "sim/world/dynamics.hpp"

namespace constrictor {

/// msg::kTouched…; sim/physics/sensors.cpp compares the numbers.
enum class Touched : std::uint8_t { kGround = 0, kSelf = 1, kObject = 2, kObstacle = 3 };

/// A contact that a module feels. Vectors are in the module's frame; the force is the mean over the last advance().
struct ModuleContact {
  std::uint8_t module_index = 0;
  Touched touched = Touched::kGround;
  std::uint8_t touched_index = 0;  ///< index of the touched object, obstacle or module
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d normal{0.0, 0.0, 1.0};   ///< unit vector that points into the module
  Eigen::Vector3d force_n{0.0, 0.0, 0.0};  ///< on the module
};

class ContactSet {
 public:
  ContactSet();

  /// Call at the beginning of a tick: clears the sums of the previous tick.
  void begin_tick();
  /// Call at the beginning of each step: removes the contacts of the previous step.
  void begin_step();
  /// Adds a contact that no module feels.
  void add(const SolverContact& contact) { contacts_.push_back(contact); }
  /// Adds a contact that its first body, a module, feels. `index` is that of what it touches; `feature` distinguishes
  /// several contacts of one pair.
  void add_felt(const SolverContact& contact, Touched touched, std::size_t index, std::size_t feature);
  /// The contacts of the present step.
  [[nodiscard]] std::span<const SolverContact> contacts() const { return contacts_; }
  /// Call after the step: adds its forces to the sums of the tick.
  void collect(const Dynamics& dynamics);
  /// [W] power that the felt contacts of the last step give to the bodies; negative, because friction takes energy.
  [[nodiscard]] double felt_power_w(const Dynamics& dynamics) const;
  /// Mean contacts of the tick so far, in the order of falling force.
  [[nodiscard]] std::vector<ModuleContact> felt() const;

  /// The sums of the last tick. The contacts of the last step are not part of it: begin_step() removes them.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sums_, steps_);
  }

 private:
  struct Felt {  // a contact of the present step that a module feels
    std::size_t contact;
    std::uint32_t key;
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

  void sum_up(std::uint32_t key, const BodyMotion& body, const TouchPoint& touch, const Eigen::Vector3d& normal,
              const Eigen::Vector3d& force_n);

  std::vector<SolverContact> contacts_;
  std::vector<Felt> felt_;
  std::vector<Sum> sums_;  // ordered by key
  int steps_ = 0;
};

}  // namespace constrictor
