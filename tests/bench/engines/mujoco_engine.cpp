#include "bench/engines/mujoco_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/mujoco_model.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

/// The object is a cylinder on the ground. The modules touch a capsule whose side is that of the cylinder, because
/// MuJoCo computes contacts of capsules exactly, and those of cylinders only by an iteration.
std::string with_object(std::string xml, const RobotModel& robot, const ScenarioObject& object) {
  const ScenarioFriction friction;
  const double half_m = 0.5 * object.size_m.z();
  const std::string body =
      fmt::format(R"(<body name="object" pos="{} {} {}"><freejoint/>)"
                  R"(<geom name="object" type="cylinder" size="{} {}" mass="{}" contype="0" conaffinity="0"/>)"
                  R"(<geom name="side" type="capsule" size="{} {}" mass="0" contype="0" conaffinity="0"/></body>)",
                  object.position_m.x(), object.position_m.y(), half_m, object.size_m.x(), half_m, object.mass_kg,
                  object.size_m.x(), half_m);
  const auto pair = [](const std::string& first, const std::string& second, double coefficient) {
    return fmt::format(R"(<pair geom1="{0}" geom2="{1}" condim="3" friction="{2} {2} 0.005 0.0001 0.0001"/>)", first,
                       second, coefficient);
  };
  std::string pairs = pair("ground", "object", friction.object_ground);
  for (std::size_t i = 0; i < robot.module_count; ++i)
    pairs += pair("side", fmt::format("module_{}", i), friction.object_robot);
  xml.insert(xml.find("</worldbody>"), body);
  xml.insert(xml.find("</contact>"), pairs);
  return xml;
}

/// Replaces the line of the model that begins with `begin`.
void replace_line(std::string& xml, const std::string& begin, const std::string& line) {
  const auto at = xml.find(begin);
  if (at == std::string::npos) throw std::logic_error("the MuJoCo model has no line " + begin);
  xml.replace(at, xml.find('\n', at) - at, line);
}

std::string with_ground_contact(std::string xml, const RobotModel& robot, GroundContact ground) {
  const double half_m = 0.5 * robot.module_length_m;
  // A contact that carries half of the weight of two needs twice the coefficients. MuJoCo accepts no coefficient of 0;
  // the small one of the contact across takes part in the friction along.
  constexpr double kSmall = 0.003;
  const std::string begin = R"(<pair geom1="ground" geom2=)";
  const auto pair = [&begin](const std::string& geom, double along, double across) {
    return fmt::format(R"({}"{}" condim="3" friction="{} {} 0.005 0.0001 0.0001" )"
                       R"(solref="-9900 -4.95" solimp="0.1 0.1 0.001"/>)",
                       begin, geom, along, across);
  };
  for (std::size_t i = 0; i < robot.module_count; ++i) {
    const std::string module = fmt::format("module_{}", i);
    const std::string old_pair = fmt::format("{}\"{}\"", begin, module);
    if (ground == GroundContact::kLasting) {
      replace_line(xml, old_pair, pair(module, robot.friction_along, robot.friction_across));
      continue;
    }
    const std::string twin = fmt::format("across_{}", i);
    replace_line(xml, old_pair,
                 pair(module, 2.0 * robot.friction_along - kSmall, kSmall) +
                     pair(twin, kSmall, 2.0 * robot.friction_across - kSmall));
    xml.insert(xml.find(fmt::format(R"(<geom name="{}")", module)),
               fmt::format(R"(<geom name="{}" type="capsule" fromto="{} 0 0 {} 0 0" size="{}" mass="0" )"
                           R"(contype="0" conaffinity="0"/>)",
                           twin, half_m, -half_m, robot.module_radius_m));
  }
  return xml;
}

std::string model_text(const RobotModel& robot, const MujocoSettings& settings,
                       const std::optional<ScenarioObject>& object) {
  std::string xml = mujoco_model(robot);
  if (object) xml = with_object(xml, robot, *object);
  return settings.ground == GroundContact::kExported ? xml : with_ground_contact(xml, robot, settings.ground);
}

}  // namespace

MujocoEngine::MujocoEngine(const RobotModel& robot, const MujocoSettings& settings,
                           const std::optional<ScenarioObject>& object)
    : robot_(robot), settings_(settings), model_(testing::compile_mujoco_model(model_text(robot, settings, object))) {
  mjOption& option = model_->opt;
  option.timestep = settings.step_s;
  option.solver = settings.solver;
  option.iterations = settings.iterations;
  option.tolerance = settings.tolerance;
  if (settings.ground == GroundContact::kRectangle) option.impratio = 1.0;  // the coefficients already differ enough
  data_.reset(mj_makeData(model_.get()));
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, fmt::format("joint_{}", i).c_str());
    dof_.push_back(model_->jnt_dofadr[joint]);
    angle_.push_back(model_->jnt_qposadr[joint]);
    to_.push_back({0.0, 0.0, robot.joints[i].max_torque_nm});
  }
  for (std::size_t i = 0; i < robot.module_count; ++i)
    body_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, fmt::format("module_{}", i).c_str()));
  object_body_ = mj_name2id(model_.get(), mjOBJ_BODY, "object");
  from_ = to_;
  rate_before_.resize(to_.size());
  step_torque_nm_.resize(to_.size());
  mj_forward(model_.get(), data_.get());
}

double MujocoEngine::joint_angle_rad(std::size_t joint) const { return data_->qpos[angle_[joint]]; }

Vector3d MujocoEngine::module_position_m(std::size_t module) const {
  return Eigen::Map<const Vector3d>(data_->xpos + 3 * body_[module]);
}

Vector3d MujocoEngine::object_position_m() const { return Eigen::Map<const Vector3d>(data_->xpos + 3 * object_body_); }

// The same torque as stand_on_bellies of sim/world.
void MujocoEngine::stand_on_bellies() {
  const double most_nm = robot_.module_mass_kg * 9.81 * robot_.module_belly_half_width_m;
  for (const int body : body_) {
    const mjtNum* R = data_->xmat + 9 * body;
    const Vector3d x(R[0], R[3], R[6]);
    mjtNum velocity[6];  // angular, then linear
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, body, velocity, 0);
    const double roll_rad = std::atan2(R[7], R[8]);
    Vector3d torque = Vector3d::Zero();
    if (std::abs(roll_rad) <= 0.8 && data_->xpos[3 * body + 2] <= robot_.module_radius_m + 0.01) {
      const double rate_rad_s = Vector3d(velocity[0], velocity[1], velocity[2]).dot(x);
      torque = -most_nm * std::clamp((roll_rad + 0.01 * rate_rad_s) / 0.05, -1.0, 1.0) * x;
    }
    Eigen::Map<Vector3d>(data_->xfrc_applied + 6 * body + 3) = torque;
  }
}

/// One step from share u0 to share u1 of the tick.
void MujocoEngine::step(double u0, double u1, double period_s) {
  for (std::size_t i = 0; i < to_.size(); ++i) {
    const JointModel& joint = robot_.joints[i];
    // The cubic curve of sim/world's servo. MuJoCo compares the angle at the beginning of a step and, with the implicit
    // integrator, the rate at its end.
    const double d = to_[i].position_rad - from_[i].position_rad;
    const double a = from_[i].velocity_rad_s * period_s;
    const double b = to_[i].velocity_rad_s * period_s;
    const double c2 = 3.0 * d - 2.0 * a - b;
    const double c3 = a + b - 2.0 * d;
    const double angle = from_[i].position_rad + u0 * (a + u0 * (c2 + u0 * c3));
    const double rate = (a + u1 * (2.0 * c2 + u1 * 3.0 * c3)) / period_s;
    data_->ctrl[i] = angle + joint.velocity_gain_nm_s_rad / joint.position_gain_nm_rad * rate;
    model_->actuator_forcerange[2 * i] = -to_[i].torque_limit_nm;
    model_->actuator_forcerange[2 * i + 1] = to_[i].torque_limit_nm;
    rate_before_[i] = data_->qvel[dof_[i]];
  }
  stand_on_bellies();
  mj_step(model_.get(), data_.get());
  for (std::size_t i = 0; i < to_.size(); ++i) {
    const JointModel& joint = robot_.joints[i];
    const double change = data_->qvel[dof_[i]] - rate_before_[i];
    // MuJoCo reports the force for the rate at the beginning; the implicit integrator applied that for the rate at the
    // end.
    step_torque_nm_[i] = data_->actuator_force[i] - joint.velocity_gain_nm_s_rad * change -
                         joint.rotor_inertia_kg_m2 * change / settings_.step_s;
  }
}

void MujocoEngine::tick(const ServoCommand& command, double period_s, const std::function<void()>& after_step) {
  for (std::size_t i = 0; i < to_.size(); ++i) {
    to_[i] = clamp_to_limits(robot_.joints[i],
                             {command.position_rad[i], command.velocity_rad_s[i], command.torque_limit_nm[i]});
  }
  const int count = std::max(1, static_cast<int>(std::lround(period_s / settings_.step_s)));
  for (int i = 0; i < count; ++i) {
    step(static_cast<double>(i) / count, static_cast<double>(i + 1) / count, period_s);
    if (after_step) after_step();
  }
  from_ = to_;
}

}  // namespace constrictor
