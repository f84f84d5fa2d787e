// MuJoCo compiles the model that is written for it, and agrees with this project about masses, inertia, kinematics,
// servos and friction. Built only where MuJoCo is installed.
#include <gtest/gtest.h>

#include <random>

#include "robot/kinematics.hpp"
#include "robot/mujoco_model.hpp"
#include "support/mujoco_model.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

constexpr double kGravity_m_s2 = 9.81;

/// A robot in MuJoCo, lying straight on the ground at rest.
class MujocoModelTest : public ::testing::TestWithParam<const char*> {
 protected:
  MujocoModelTest()
      : robot_(load_robot(testing::robot_path(GetParam()))),
        model_(testing::compile_mujoco_model(mujoco_model(robot_))),
        data_(mj_makeData(model_.get())) {}

  [[nodiscard]] bool elastic() const { return robot_.joints.front().stiffness_nm_rad > 0.0; }
  [[nodiscard]] int id(mjtObj type, const char* name, std::size_t number) const {
    return mj_name2id(model_.get(), type, fmt::format("{}_{}", name, number).c_str());
  }
  [[nodiscard]] int body(std::size_t module) const { return id(mjOBJ_BODY, "module", module); }
  /// The hinge that the actuator drives.
  [[nodiscard]] int motor(std::size_t joint) const { return id(mjOBJ_JOINT, elastic() ? "motor" : "joint", joint); }
  [[nodiscard]] Vector3d position_m(std::size_t module) const {
    return Eigen::Map<const Vector3d>(data_->xpos + 3 * body(module));
  }
  [[nodiscard]] double& angle(int joint) { return data_->qpos[model_->jnt_qposadr[joint]]; }
  [[nodiscard]] double& rate(int joint) { return data_->qvel[model_->jnt_dofadr[joint]]; }

  RobotModel robot_;
  testing::MujocoModel model_;
  testing::MujocoData data_;
};

TEST_P(MujocoModelTest, HasTheMassAndTheInertiaOfSolidCapsules) {
  const double mass = robot_.module_mass_kg;
  const double r = robot_.module_radius_m;
  const double l = robot_.module_length_m;
  const double sphere = mass * (4.0 / 3.0 * r) / (l + 4.0 / 3.0 * r);  // the caps' share of the mass
  const double cylinder = mass - sphere;
  // The centre of mass of each half sphere is 3/8 r beyond the end of the cylinder.
  const double across = cylinder * (r * r / 4 + l * l / 12) + sphere * (0.4 * r * r + l * l / 4 + 3.0 / 8.0 * l * r);
  const double along = cylinder * r * r / 2 + sphere * 0.4 * r * r;
  EXPECT_NEAR(mj_getTotalmass(model_.get()), mass * static_cast<double>(robot_.module_count), 1e-9);
  mj_forward(model_.get(), data_.get());
  double about_vertical = 0.0;  // of the straight robot, about its centre
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < robot_.module_count; ++i)
    centre += position_m(i) / static_cast<double>(robot_.module_count);
  for (std::size_t i = 0; i < robot_.module_count; ++i) {
    const mjtNum* inertia = model_->body_inertia + 3 * body(i);  // principal moments, the largest first
    std::vector<double> moments(inertia, inertia + 3);
    std::sort(moments.begin(), moments.end());
    EXPECT_NEAR(moments[0], along, 1e-6 * along);
    EXPECT_NEAR(moments[1], across, 1e-6 * across);
    EXPECT_NEAR(moments[2], across, 1e-6 * across);
    about_vertical += across + mass * (position_m(i) - centre).squaredNorm();
  }
  // The inertia of the whole robot, by MuJoCo: the kinetic energy of a rotation with 1 rad/s is half of it.
  std::vector<mjtNum> full(static_cast<std::size_t>(model_->nv * model_->nv));
  mj_fullM(model_.get(), full.data(), data_->qM);
  const double x = -centre.x();  // the head rotates about the centre
  const auto entry = [&](int i, int j) {
    return full[static_cast<std::size_t>(i) * static_cast<std::size_t>(model_->nv) + static_cast<std::size_t>(j)];
  };
  EXPECT_NEAR(entry(5, 5) + 2.0 * x * entry(5, 1) + x * x * entry(1, 1), about_vertical, 1e-6 * about_vertical);
}

TEST_P(MujocoModelTest, HasTheJointsOfTheRobotFile) {
  EXPECT_EQ(model_->nu, static_cast<int>(robot_.joints.size()));
  EXPECT_EQ(model_->njnt, static_cast<int>((elastic() ? 2 : 1) * robot_.joints.size()) + 1);
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    const JointModel& joint = robot_.joints[i];
    EXPECT_EQ(model_->dof_armature[model_->jnt_dofadr[motor(i)]], joint.rotor_inertia_kg_m2);
    EXPECT_EQ(model_->dof_frictionloss[model_->jnt_dofadr[motor(i)]], joint.gear_friction_nm);
    const int limit = elastic() ? id(mjOBJ_TENDON, "joint", i) : motor(i);
    const mjtNum* range = (elastic() ? model_->tendon_range : model_->jnt_range) + 2 * limit;
    EXPECT_TRUE((elastic() ? model_->tendon_limited : model_->jnt_limited)[limit]);
    EXPECT_EQ(range[0], joint.min_rad);
    EXPECT_EQ(range[1], joint.max_rad);
    if (!elastic()) continue;
    const int spring = id(mjOBJ_JOINT, "spring", i);
    EXPECT_EQ(model_->jnt_stiffness[spring], joint.stiffness_nm_rad);
    EXPECT_EQ(model_->dof_damping[model_->jnt_dofadr[spring]], joint.damping_nm_s_rad);
  }
}

TEST_P(MujocoModelTest, MovesItsModulesAsTheKinematicsOfThisProject) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<double> angles(robot_.joints.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] = any(random);
    const double stretched = elastic() ? 0.1 * any(random) : 0.0;
    angle(motor(i)) = angles[i] - stretched;
    if (elastic()) angle(id(mjOBJ_JOINT, "spring", i)) = stretched;
  }
  mj_forward(model_.get(), data_.get());
  Eigen::Isometry3d X_WHead = Eigen::Isometry3d::Identity();
  X_WHead.translation().z() = robot_.module_radius_m;
  const auto poses = module_poses(robot_, angles, X_WHead);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((position_m(i) - poses[i].translation()).norm(), 1e-9) << i;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->xmat + 9 * body(i));
    EXPECT_LT((R - poses[i].linear()).norm(), 1e-9) << i;
  }
  if (!elastic()) return;
  for (std::size_t i = 0; i < angles.size(); ++i)
    EXPECT_NEAR(data_->ten_length[id(mjOBJ_TENDON, "joint", i)], angles[i], 1e-12);
}

TEST_P(MujocoModelTest, DrivesItsJointsWithBothGainsUpToTheLimitOfTheTorque) {
  const JointModel& joint = robot_.joints[4];
  const double setpoint_rad = 0.11;
  const double setpoint_rate_rad_s = 0.5;
  angle(motor(4)) = 0.1;
  rate(motor(4)) = 0.2;
  data_->ctrl[4] = setpoint_rad + joint.velocity_gain_nm_s_rad / joint.position_gain_nm_rad * setpoint_rate_rad_s;
  mj_forward(model_.get(), data_.get());
  EXPECT_NEAR(
      data_->actuator_force[4],
      joint.position_gain_nm_rad * (setpoint_rad - 0.1) + joint.velocity_gain_nm_s_rad * (setpoint_rate_rad_s - 0.2),
      1e-9);
  data_->ctrl[4] = joint.min_rad;
  mj_forward(model_.get(), data_.get());
  EXPECT_EQ(data_->actuator_force[4], -joint.max_torque_nm);
  EXPECT_EQ(model_->actuator_trnid[2 * 4], motor(4));
}

TEST_P(MujocoModelTest, SlidesWithTheFrictionAlongAndAcrossItsModules) {
  struct Case {
    double heading_rad;  // of the robot
    double course_rad;   // direction of sliding, from the heading
    double coefficient;
  };
  for (const Case& c : {Case{0.0, 0.0, robot_.friction_along}, Case{0.0, M_PI / 2, robot_.friction_across},
                        Case{0.6, 0.0, robot_.friction_along}, Case{0.6, M_PI / 2, robot_.friction_across},
                        Case{-2.0, -M_PI / 2, robot_.friction_across}}) {
    mj_resetData(model_.get(), data_.get());
    data_->qpos[3] = std::cos(0.5 * c.heading_rad);
    data_->qpos[6] = std::sin(0.5 * c.heading_rad);
    while (data_->time < 0.5) mj_step(model_.get(), data_.get());  // the body sinks into the ground and rests
    constexpr double kSpeed_m_s = 2.0;  // fast, so that the robot still slides when friction begins to roll it
    const Vector3d course(std::cos(c.heading_rad + c.course_rad), std::sin(c.heading_rad + c.course_rad), 0.0);
    Eigen::Map<Vector3d>(data_->qvel) = kSpeed_m_s * course;
    const auto velocity = [&] {  // of the centre of mass
      mj_forward(model_.get(), data_.get());
      mj_subtreeVel(model_.get(), data_.get());
      return Vector3d(Eigen::Map<const Vector3d>(data_->subtree_linvel + 3 * body(0)));
    };
    const Vector3d before = velocity();
    const double from_s = data_->time;
    while (data_->time < from_s + 0.03) mj_step(model_.get(), data_.get());
    const Vector3d change = velocity() - before;
    // MuJoCo's contacts push a body upwards when it begins to slide, therefore the normal force is not the weight.
    const double normal = change.z() + kGravity_m_s2 * (data_->time - from_s);
    EXPECT_NEAR(-change.dot(course) / normal, c.coefficient, 0.03 * c.coefficient)
        << "heading " << c.heading_rad << " course " << c.course_rad;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, MujocoModelTest, ::testing::Values("mamba", "serpens"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace constrictor
