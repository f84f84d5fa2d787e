// The robot as descriptions that other programs read: names, frames and masses that URDF and SDF share.
//
// Frames of links: `base_link` is the head module, with the origin at its centre. The frame of every other module has
// its origin on the axis of the joint to the module ahead, because a URDF file cannot put it elsewhere: half a module
// ahead of the module's centre. `camera_optical` is the head's camera (z along the view, x right, y down),
// `camera_NAME_optical` a further one. With all angles 0 all frames of modules have the same orientation: x forward, y
// left, z up.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>

#include "robot/robot_model.hpp"

namespace constrictor {

/// joint_00 is next to the head.
[[nodiscard]] std::string joint_name(std::size_t joint);
/// base_link is the head, module_01 the next one.
[[nodiscard]] std::string link_name(std::size_t module);
inline constexpr const char* kCameraFrame = "camera_optical";
/// The frame of a camera of the robot.
[[nodiscard]] std::string camera_frame(const CameraModel& camera);
/// Pose of a camera (z along the view, x right, y down) in the frame of the link that carries it.
[[nodiscard]] Eigen::Isometry3d camera_in_link(const RobotModel& robot, const CameraModel& camera);

/// Position of a module's centre in the frame of its link [m].
[[nodiscard]] Eigen::Vector3d centre_in_link(const RobotModel& robot, std::size_t module);
/// Axis of a joint in the frame of the link behind it, for the signs of this project: other formats turn the link
/// behind relative to the link ahead, RobotModel turns the one ahead relative to the one behind.
[[nodiscard]] Eigen::Vector3d joint_axis_of_link(JointAxis axis);

/// Principal moments of inertia of a module about its centre [kg m²]: along its axis (x), and across it (y and z).
struct ModuleInertia {
  double along_kg_m2 = 0.0;
  double across_kg_m2 = 0.0;
};
/// The inertia of a module as a homogeneous capsule, as in the simulator.
[[nodiscard]] ModuleInertia module_inertia(const RobotModel& robot);

/// The text of a URDF file: links with masses, inertias and shapes, joints with axes, limits and friction, the frames
/// of the cameras. URDF has no capsule: each is a cylinder and two spheres, which together are exactly the capsule.
/// `mesh`: URI of a mesh of the module (module_mesh.hpp), which is then drawn; empty: the shapes are drawn.
/// Source: wiki.ros.org/urdf/XML, urdfdom 3.0.
[[nodiscard]] std::string urdf_model(const RobotModel& robot, const std::string& mesh = {});

/// The text of an SDF 1.9 file: the same with capsules, the friction of the skin along and across each module, and the
/// cameras as sensors. The robot lies straight on the ground, the head above the origin. `tick_s`: the control period
/// [s], from which the rate of the camera follows. `mesh`: as above. Source: sdformat.org/spec?ver=1.9.
[[nodiscard]] std::string sdf_model(const RobotModel& robot, const std::string& mesh = {}, double tick_s = 0.02);

}  // namespace constrictor
