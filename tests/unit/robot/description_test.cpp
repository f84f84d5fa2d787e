// The URDF and SDF files of a robot, read by the parsers of ROS and Gazebo, against the robot's own kinematics, against
// ODE's inertia of a capsule, and against the robot file.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ode/ode.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>
#include <sdf/sdf.hh>

#include "robot/camera_mount.hpp"
#include "robot/description.hpp"
#include "robot/kinematics.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A description of a robot as its parser understood it.
struct Parsed {
  struct Link {
    double mass_kg = 0.0;
    Isometry3d X_LinkInertia = Isometry3d::Identity();
    Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
  };
  struct Joint {
    std::string parent, child;
    Isometry3d X_ParentChild = Isometry3d::Identity();  ///< at the angle 0; the child's frame lies on the axis
    Vector3d axis = Vector3d::Zero();                   ///< in the child's frame
    double min_rad = 0, max_rad = 0, max_torque_nm = 0, max_speed_rad_s = 0, friction_nm = 0;
  };
  std::string name;
  std::map<std::string, Link> links;  ///< with mass
  std::map<std::string, Joint> joints;
  Isometry3d X_HC = Isometry3d::Identity();
};

Isometry3d isometry(const urdf::Pose& pose) {
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
}

Isometry3d isometry(const ignition::math::Pose3d& pose) {
  return Eigen::Translation3d(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z()) *
         Eigen::Quaterniond(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z());
}

Eigen::Matrix3d symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

Parsed parse_urdf(const RobotModel& robot) {
  const auto model = urdf::parseURDF(urdf_model(robot));
  if (!model) throw std::runtime_error("urdfdom refuses the file");
  Parsed parsed;
  parsed.name = model->getName();
  EXPECT_EQ(model->getRoot()->name, "base_link");
  for (const auto& [name, link] : model->links_) {
    if (!link->inertial) continue;
    const auto& i = *link->inertial;
    parsed.links[name] = {i.mass, isometry(i.origin), symmetric(i.ixx, i.iyy, i.izz, i.ixy, i.ixz, i.iyz)};
  }
  for (const auto& [name, joint] : model->joints_) {
    if (joint->type == urdf::Joint::FIXED) {
      EXPECT_EQ(joint->child_link_name, "camera_optical");
      parsed.X_HC = isometry(joint->parent_to_joint_origin_transform);
      continue;
    }
    EXPECT_EQ(joint->type, urdf::Joint::REVOLUTE) << name;
    parsed.joints[name] = {joint->parent_link_name,
                           joint->child_link_name,
                           isometry(joint->parent_to_joint_origin_transform),
                           {joint->axis.x, joint->axis.y, joint->axis.z},
                           joint->limits->lower,
                           joint->limits->upper,
                           joint->limits->effort,
                           joint->limits->velocity,
                           joint->dynamics->friction};
  }
  return parsed;
}

/// Loads a text as `ign sdf --check` does, and fails the test for each error.
const sdf::Model& load_sdf(sdf::Root& root, const std::string& text) {
  for (const auto& error : root.LoadSdfString(text)) ADD_FAILURE() << error.Message();
  EXPECT_TRUE(sdf::checkCanonicalLinkNames(&root));
  EXPECT_TRUE(sdf::checkJointParentChildLinkNames(&root));
  EXPECT_TRUE(sdf::checkFrameAttachedToNames(&root));
  EXPECT_TRUE(sdf::checkFrameAttachedToGraph(&root));
  EXPECT_TRUE(sdf::checkPoseRelativeToGraph(&root));
  if (!root.Model()) throw std::runtime_error("sdformat found no model");
  return *root.Model();
}

Parsed parse_sdf(const RobotModel& robot) {
  sdf::Root root;
  const sdf::Model& model = load_sdf(root, sdf_model(robot));
  Parsed parsed;
  parsed.name = model.Name();
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const auto& inertial = model.LinkByIndex(i)->Inertial();
    const auto& m = inertial.MassMatrix();
    parsed.links[model.LinkByIndex(i)->Name()] = {m.Mass(), isometry(inertial.Pose()),
                                                  symmetric(m.Ixx(), m.Iyy(), m.Izz(), m.Ixy(), m.Ixz(), m.Iyz())};
  }
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
    const sdf::Joint& joint = *model.JointByIndex(i);
    const sdf::JointAxis& axis = *joint.Axis();
    Parsed::Joint one;
    one.parent = joint.ParentLinkName();
    one.child = joint.ChildLinkName();
    ignition::math::Pose3d pose;
    EXPECT_TRUE(model.LinkByName(one.child)->SemanticPose().Resolve(pose, one.parent).empty());
    one.X_ParentChild = isometry(pose);
    EXPECT_TRUE(joint.SemanticPose().Resolve(pose, one.child).empty());
    EXPECT_LT(isometry(pose).translation().norm(), 1e-15) << "the child's frame must lie on the axis";
    ignition::math::Vector3d direction;
    EXPECT_TRUE(axis.ResolveXyz(direction, one.child).empty());
    one.axis = {direction.X(), direction.Y(), direction.Z()};
    one.min_rad = axis.Lower();
    one.max_rad = axis.Upper();
    one.max_torque_nm = axis.Effort();
    one.max_speed_rad_s = axis.MaxVelocity();
    one.friction_nm = axis.Friction();
    parsed.joints[joint.Name()] = one;
  }
  ignition::math::Pose3d camera;
  EXPECT_TRUE(model.FrameByName("camera_optical")->SemanticPose().Resolve(camera, "base_link").empty());
  parsed.X_HC = isometry(camera);
  return parsed;
}

/// The centres of all modules, head to tail, for a posture, from nothing but the description.
std::vector<Isometry3d> centres(const Parsed& parsed, const std::vector<double>& angles_rad) {
  std::vector<Isometry3d> list;
  Isometry3d X_WLink = Isometry3d::Identity();
  std::string link = "base_link";
  for (;;) {
    list.push_back(X_WLink * parsed.links.at(link).X_LinkInertia);
    const auto next = std::find_if(parsed.joints.begin(), parsed.joints.end(),
                                   [&](const auto& joint) { return joint.second.parent == link; });
    if (next == parsed.joints.end()) return list;
    const double angle_rad = angles_rad.at(std::stoul(next->first.substr(6)));
    X_WLink = X_WLink * next->second.X_ParentChild * Eigen::AngleAxisd(angle_rad, next->second.axis);
    link = next->second.child;
  }
}

class Description : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  Description()
      : robot_(load_robot(testing::robot_path(std::get<1>(GetParam())))),
        parsed_(std::get<0>(GetParam()) == std::string("urdf") ? parse_urdf(robot_) : parse_sdf(robot_)) {}
  RobotModel robot_;
  Parsed parsed_;
};

TEST_P(Description, EveryModuleIsWhereTheRobotsKinematicsPutsIt) {
  std::mt19937 random(7);
  for (int posture = 0; posture < 10; ++posture) {
    std::vector<double> angles_rad;
    for (const JointModel& joint : robot_.joints)
      angles_rad.push_back(std::uniform_real_distribution<double>(joint.min_rad, joint.max_rad)(random));
    const auto found = centres(parsed_, angles_rad);
    const auto expected = module_poses(robot_, angles_rad);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_LT((found[i].matrix() - expected[i].matrix()).norm(), 1e-9) << "module " << i;
  }
}

TEST_P(Description, MassesAndInertiasAreThoseOfTheSimulatedCapsules) {
  dMass capsule;
  dMassSetCapsuleTotal(&capsule, robot_.module_mass_kg, 1, robot_.module_radius_m, robot_.module_length_m);
  double total_kg = 0;
  ASSERT_EQ(parsed_.links.size(), robot_.module_count);
  for (const auto& [name, link] : parsed_.links) {
    total_kg += link.mass_kg;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(link.inertia_kg_m2(row, column), capsule.I[4 * row + column], 1e-9 * capsule.I[5]) << name;
    }
    const Vector3d principal = link.inertia_kg_m2.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(principal.minCoeff(), 0);
    EXPECT_GE(principal.sum(), 2 * principal.maxCoeff()) << "no body has such moments";
  }
  EXPECT_NEAR(total_kg, static_cast<double>(robot_.module_count) * robot_.module_mass_kg, 1e-12);
}

TEST_P(Description, JointsHaveTheLimitsOfTheRobotFile) {
  ASSERT_EQ(parsed_.joints.size(), robot_.joints.size());
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    const JointModel& expected = robot_.joints[i];
    const auto& joint = parsed_.joints.at(fmt::format("joint_{:02}", i));
    EXPECT_EQ(joint.min_rad, expected.min_rad);
    EXPECT_EQ(joint.max_rad, expected.max_rad);
    EXPECT_EQ(joint.max_torque_nm, expected.max_torque_nm);
    EXPECT_EQ(joint.max_speed_rad_s, expected.max_speed_rad_s);
    EXPECT_EQ(joint.friction_nm, expected.gear_friction_nm);
  }
}

TEST_P(Description, TheCameraIsWhereItIsMounted) {
  EXPECT_LT((parsed_.X_HC.matrix() - camera_mount(robot_.camera).matrix()).norm(), 1e-12);
  EXPECT_EQ(parsed_.name, robot_.name);
}

INSTANTIATE_TEST_SUITE_P(OfTheShippedRobots, Description,
                         ::testing::Combine(::testing::Values("urdf", "sdf"),
                                            ::testing::Values("mamba", "mamba_mx106", "serpens")),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) + "_" + std::get<1>(instance.param);
                         });

RobotModel mamba() { return load_robot(testing::robot_path("mamba")); }

TEST(UrdfDescription, CylinderAndSpheresAreTogetherTheCapsule) {
  const RobotModel robot = mamba();
  const auto model = urdf::parseURDF(urdf_model(robot));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  for (const auto& [name, link] : model->links_) {
    if (name == "camera_optical") continue;
    EXPECT_EQ(link->visual_array.size(), 3u);
    ASSERT_EQ(link->collision_array.size(), 3u);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3d p_Module(place(random), place(random), place(random));
      const Vector3d p_Link = isometry(link->inertial->origin) * p_Module;
      bool in_shapes = false;
      for (const auto& collision : link->collision_array) {
        const Vector3d p = isometry(collision->origin).inverse() * p_Link;
        if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(collision->geometry.get()))
          in_shapes = in_shapes || p.norm() < sphere->radius;
        if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(collision->geometry.get()))
          in_shapes = in_shapes || (p.head<2>().norm() < rod->radius && std::abs(p.z()) < rod->length / 2);
      }
      Vector3d from_axis = p_Module;
      const double half_m = robot.module_length_m / 2;
      from_axis.x() -= std::clamp(p_Module.x(), -half_m, half_m);
      EXPECT_EQ(in_shapes, from_axis.norm() < robot.module_radius_m) << p_Module.transpose();
      inside += in_shapes;
    }
    EXPECT_GT(inside, 20);
  }
}

TEST(SdfDescription, CapsulesSlideAlongTheBodyAndTheCameraLooksAsMounted) {
  const RobotModel robot = mamba();
  sdf::Root root;
  const sdf::Model& model = load_sdf(root, sdf_model(robot));
  EXPECT_EQ(model.RawPose().Pos().Z(), robot.module_radius_m) << "the robot must lie on the ground";
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Collision& collision = *model.LinkByIndex(i)->CollisionByIndex(0);
    const sdf::Capsule* capsule = collision.Geom()->CapsuleShape();
    ASSERT_TRUE(capsule);
    EXPECT_EQ(capsule->Radius(), robot.module_radius_m);
    EXPECT_EQ(capsule->Length(), robot.module_length_m);
    const Isometry3d X_LinkCapsule = isometry(collision.RawPose());
    EXPECT_LT((X_LinkCapsule.linear() * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-12);
    const auto friction = collision.Element()->GetElement("surface")->GetElement("friction")->GetElement("ode");
    EXPECT_EQ(friction->Get<double>("mu"), robot.friction_along);
    EXPECT_EQ(friction->Get<double>("mu2"), robot.friction_across);
    const auto first = friction->Get<ignition::math::Vector3d>("fdir1");
    const Vector3d along = X_LinkCapsule.linear() * Vector3d(first.X(), first.Y(), first.Z());
    EXPECT_LT((along - Vector3d::UnitX()).norm(), 1e-12) << "the first direction is along the module";
  }
  const sdf::Sensor* sensor = model.LinkByName("base_link")->SensorByName("camera");
  ASSERT_TRUE(sensor && sensor->CameraSensor());
  EXPECT_EQ(sensor->UpdateRate(), 10);
  EXPECT_EQ(sensor->CameraSensor()->HorizontalFov().Radian(), robot.camera.horizontal_fov_rad);
  EXPECT_EQ(sensor->CameraSensor()->ImageWidth(), 320u);
  // SDF's camera looks along x with z up; ours along z with x right and y down.
  const Isometry3d X_HS = isometry(sensor->RawPose());
  const Isometry3d X_HC = camera_mount(robot.camera);
  EXPECT_LT((X_HS.linear().col(0) - X_HC.linear().col(2)).norm(), 1e-12);
  EXPECT_LT((X_HS.linear().col(2) + X_HC.linear().col(1)).norm(), 1e-12);
  EXPECT_LT((X_HS.translation() - X_HC.translation()).norm(), 1e-12);
}

TEST(Descriptions, SurviveANameThatXmlMustEscape) {
  RobotModel robot = mamba();
  robot.name = "a<b>&\"c\"";
  EXPECT_EQ(parse_urdf(robot).name, robot.name);
  EXPECT_EQ(parse_sdf(robot).name, robot.name);
}

}  // namespace
}  // namespace constrictor
