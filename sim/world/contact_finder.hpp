// Finds the contacts between the bodies of a scene in each step: modules with the ground, with each other, with objects
// and obstacles; objects with the ground, with each other and with obstacles.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"
#include "sim/world/collision.hpp"
#include "sim/world/contact_set.hpp"
#include "sim/world/dynamics.hpp"
#include "sim/world/ode_handles.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

class ContactFinder {
 public:
  /// Copies what it needs. Does not throw for arguments that load_robot and load_scenario accept.
  ContactFinder(const RobotModel& robot, const Scenario& scenario, const SolverSettings& settings);

  /// Adds the contacts of the bodies as they are now. `dynamics` has the bodies of mechanism_of() for the same robot
  /// and scenario.
  void find(const Dynamics& dynamics, ContactSet& contacts);

 private:
  struct Obstacle {
    ConvexSolid solid;
    OdeGeom geom;
    double bound_m = 0.0;  ///< [m] radius of a sphere about the centre that contains the obstacle
  };

  void build_objects();
  void build_obstacles();
  [[nodiscard]] std::size_t object_count() const { return scenario_.objects.size(); }
  [[nodiscard]] std::size_t object_body(std::size_t object) const { return robot_.module_count + object; }
  /// Radius of a sphere about the centre of a module that contains it.
  [[nodiscard]] double module_bound_m() const { return 0.5 * robot_.module_length_m + robot_.module_radius_m; }
  [[nodiscard]] Capsule capsule_of(const BodyMotion& module) const;
  [[nodiscard]] ConvexSolid solid_of(const Dynamics& dynamics, std::size_t object) const;
  void touch_ground(const Dynamics& dynamics, std::size_t module, ContactSet& contacts);
  void touch_itself(std::size_t module, ContactSet& contacts);
  void touch_solids(const Dynamics& dynamics, std::size_t module, ContactSet& contacts);
  void collide_objects(const Dynamics& dynamics, ContactSet& contacts);
  void place_geom(const Dynamics& dynamics, std::size_t object);
  /// The geom of the object and `other` are in their places.
  void collide_geoms(dGeomID other, std::size_t object, std::size_t other_body, ContactSet& contacts);

  RobotModel robot_;
  Scenario scenario_;
  bool one_ground_contact_a_joint_;
  double step_s_;
  std::vector<OdeGeom> object_geoms_;  ///< only for contacts of objects with objects and obstacles
  std::vector<double> object_bound_m_;
  std::vector<Obstacle> obstacles_;
  std::vector<Capsule> capsules_;  ///< the modules in the present step
  TouchPoints touches_;
};

}  // namespace constrictor
