#include "robot/mujoco_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "configuration/xml_escaped.hpp"
#include "robot/xml_text.hpp"

namespace constrictor {
namespace {

// MuJoCo cannot invert the inertia of two hinges about one axis if nothing lies between them.
constexpr double kLeastRotorInertia_kg_m2 = 1e-6;
// The friction of modules on each other: the default of a scenario of the simulator.
constexpr double kModuleFriction = 0.2;

class Writer {
 public:
  explicit Writer(const RobotModel& robot) : robot_(robot) {}

  std::string write() {
    xml_.line(0, "<!-- Written by `constrictor robot export`. Units: m, kg, s, N, rad. -->");
    xml_.line(0, R"(<mujoco model="{}">)", xml_escaped(robot_.name));
    xml_.line(1, R"(<compiler angle="radian"/>)");
    xml_.line(1, R"(<size nconmax="500" njmax="2000"/>)");  // the default has no room for long robots
    // implicit: the servos' feedback of the rate would be unstable otherwise. An elliptic cone, because a pyramid has
    // less friction along its diagonals. With conjugate gradients a step takes less time than with Newton's method.
    xml_.line(1, R"(<option timestep="0.002" gravity="0 0 -9.81" integrator="implicit" cone="elliptic" impratio="10")");
    xml_.line(1, R"(        solver="CG" iterations="20" tolerance="1e-4"/>)");
    xml_.line(1, "<worldbody>");
    xml_.line(2, R"(<geom name="ground" type="plane" size="0 0 1"/>)");
    for (std::size_t i = 0; i < robot_.module_count; ++i) begin_module(i);
    for (std::size_t i = robot_.module_count; i > 0; --i) xml_.line(i + 1, "</body>");
    xml_.line(1, "</worldbody>");
    contacts();
    tendons();
    actuators();
    xml_.line(0, "</mujoco>");
    return xml_.take();
  }

 private:
  void begin_module(std::size_t i) {
    const double half_m = 0.5 * robot_.module_length_m;
    const double x_m = i == 0 ? 0.0 : -robot_.module_length_m;
    const double z_m = i == 0 ? robot_.module_radius_m : 0.0;
    xml_.line(i + 2, R"(<body name="module_{}" pos="{} 0 {}">)", i, x_m, z_m);
    if (i == 0) xml_.line(i + 3, R"(<freejoint name="head"/>)");
    else joint(i - 1, i + 3);
    xml_.line(i + 3,
              R"(<geom name="module_{}" type="capsule" fromto="{} 0 0 {} 0 0" size="{}" mass="{}" friction="{}"/>)", i,
              half_m, -half_m, robot_.module_radius_m, robot_.module_mass_kg, kModuleFriction);
  }

  /// In MuJoCo a joint turns its body, here the module behind, relative to the parent. RobotModel has the angle of the
  /// module ahead relative to the one behind: the same angle about the opposite axis.
  void joint(std::size_t i, std::size_t depth) {
    const JointModel& joint = robot_.joints[i];
    const char* axis = joint.axis == JointAxis::kYaw ? "0 0 -1" : "0 -1 0";
    const std::string where = fmt::format(R"(pos="{} 0 0" axis="{}")", 0.5 * robot_.module_length_m, axis);
    if (joint.stiffness_nm_rad > 0.0) {
      xml_.line(depth, R"(<joint name="motor_{}" {} armature="{}" frictionloss="{}"/>)", i, where,
                std::max(joint.rotor_inertia_kg_m2, kLeastRotorInertia_kg_m2), joint.gear_friction_nm);
      xml_.line(depth, R"(<joint name="spring_{}" {} stiffness="{}" damping="{}"/>)", i, where, joint.stiffness_nm_rad,
                joint.damping_nm_s_rad);
    } else {
      xml_.line(depth, R"(<joint name="joint_{}" {} limited="true" range="{} {}" armature="{}" frictionloss="{}"/>)", i,
                where, joint.min_rad, joint.max_rad, joint.rotor_inertia_kg_m2, joint.gear_friction_nm);
    }
  }

  /// The first tangent of the contact of a capsule with a plane is the capsule's axis, so that the first coefficient of
  /// a pair acts along the module and the second across it. The coefficients of a geom cannot differ in this way.
  void contacts() {
    xml_.line(1, "<contact>");
    for (std::size_t i = 0; i < robot_.module_count; ++i) {
      xml_.line(2, R"(<pair geom1="ground" geom2="module_{}" condim="3" friction="{} {} 0.005 0.0001 0.0001"/>)", i,
                robot_.friction_along, robot_.friction_across);
    }
    for (std::size_t i = 0; i < robot_.module_count; ++i) {
      for (std::size_t j = i + 1; j < robot_.module_count && j - i < kNearestSelfContact; ++j)
        xml_.line(2, R"(<exclude body1="module_{}" body2="module_{}"/>)", i, j);
    }
    xml_.line(1, "</contact>");
  }

  void tendons() {
    if (robot_.joints.front().stiffness_nm_rad == 0.0) return;
    xml_.line(1, "<tendon>");
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      xml_.line(2, R"(<fixed name="joint_{}" limited="true" range="{} {}">)", i, robot_.joints[i].min_rad,
                robot_.joints[i].max_rad);
      xml_.line(3, R"(<joint joint="motor_{}" coef="1"/>)", i);
      xml_.line(3, R"(<joint joint="spring_{}" coef="1"/>)", i);
      xml_.line(2, "</fixed>");
    }
    xml_.line(1, "</tendon>");
  }

  /// One actuator with feedback of angle and rate. `position` of MuJoCo 2.2 has no gain for the rate, and the limit on
  /// the torque of two actuators would hold for each of them by itself.
  void actuators() {
    xml_.line(1, "<actuator>");
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      const JointModel& joint = robot_.joints[i];
      xml_.line(
          2,
          R"(<general name="joint_{0}" joint="{1}_{0}" ctrllimited="true" ctrlrange="{2} {3}" forcelimited="true" )"
          R"(forcerange="{4} {5}" biastype="affine" gainprm="{6}" biasprm="0 {7} {8}"/>)",
          i, joint.stiffness_nm_rad > 0.0 ? "motor" : "joint", joint.min_rad, joint.max_rad, -joint.max_torque_nm,
          joint.max_torque_nm, joint.position_gain_nm_rad, -joint.position_gain_nm_rad, -joint.velocity_gain_nm_s_rad);
    }
    xml_.line(1, "</actuator>");
  }

  const RobotModel& robot_;
  XmlText xml_;
};

}  // namespace

std::string mujoco_model(const RobotModel& robot) { return Writer(robot).write(); }

}  // namespace constrictor
