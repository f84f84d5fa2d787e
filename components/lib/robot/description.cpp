#include "robot/description.hpp"

#include <fmt/format.h>

#include <numbers>

#include "configuration/xml_escaped.hpp"
#include "robot/camera_mount.hpp"
#include "robot/xml_text.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

std::string text_of(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

/// Roll, pitch and yaw as URDF and SDF define them: rotations about the fixed axes x, y, z, in this order.
Vector3d rpy_of(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::string pose_text(const Eigen::Isometry3d& X) {
  return text_of(X.translation()) + " " + text_of(rpy_of(X.linear()));
}

/// Turns the z axis of a cylinder or capsule into the x axis of a module.
constexpr double kLie_rad = std::numbers::pi / 2;

class UrdfWriter {
 public:
  UrdfWriter(const RobotModel& robot, const std::string& mesh) : robot_(robot), mesh_(xml_escaped(mesh)) {}

  std::string write() {
    xml_.line(0, R"(<?xml version="1.0"?>)");
    xml_.line(0, "<!-- Written by `constrictor robot export`. Units: m, kg, s, N, rad. -->");
    xml_.line(0, R"(<robot name="{}">)", xml_escaped(robot_.name));
    xml_.line(1, R"(<material name="head"><color rgba="0.84 0.37 0 1"/></material>)");
    xml_.line(1, R"(<material name="body"><color rgba="0.6 0.6 0.6 1"/></material>)");
    for (std::size_t i = 0; i < robot_.module_count; ++i) link(i);
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) joint(i);
    camera(robot_.camera, "camera_mount");
    for (const CameraModel& further : robot_.further_cameras) camera(further, "camera_" + further.name + "_mount");
    xml_.line(0, "</robot>");
    return xml_.take();
  }

 private:
  void link(std::size_t i) {
    const Vector3d centre = centre_in_link(robot_, i);
    const ModuleInertia inertia = module_inertia(robot_);
    xml_.line(1, R"(<link name="{}">)", link_name(i));
    xml_.line(2, "<inertial>");
    xml_.line(3, R"(<origin xyz="{}" rpy="0 0 0"/>)", text_of(centre));
    xml_.line(3, R"(<mass value="{}"/>)", robot_.module_mass_kg);
    xml_.line(3, R"(<inertia ixx="{0}" iyy="{1}" izz="{1}" ixy="0" ixz="0" iyz="0"/>)", inertia.along_kg_m2,
              inertia.across_kg_m2);
    xml_.line(2, "</inertial>");
    if (!mesh_.empty()) shape(i, "visual", centre, fmt::format(R"(<mesh filename="{}"/>)", mesh_), 0.0);
    for (const char* use : {"visual", "collision"}) {
      if (!mesh_.empty() && use == std::string("visual")) continue;
      shape(i, use, centre,
            fmt::format(R"(<cylinder radius="{}" length="{}"/>)", robot_.module_radius_m, robot_.module_length_m));
      for (const double end : {0.5, -0.5}) {
        shape(i, use, centre + Vector3d(end * robot_.module_length_m, 0, 0),
              fmt::format(R"(<sphere radius="{}"/>)", robot_.module_radius_m));
      }
    }
    xml_.line(1, "</link>");
  }

  void shape(std::size_t i, const char* use, const Vector3d& place, const std::string& geometry,
             double pitch_rad = kLie_rad) {
    xml_.line(2, "<{}>", use);
    xml_.line(3, R"(<origin xyz="{}" rpy="0 {} 0"/>)", text_of(place), pitch_rad);
    xml_.line(3, "<geometry>{}</geometry>", geometry);
    if (use == std::string("visual")) xml_.line(3, R"(<material name="{}"/>)", i == 0 ? "head" : "body");
    xml_.line(2, "</{}>", use);
  }

  void joint(std::size_t i) {
    const JointModel& joint = robot_.joints[i];
    const Vector3d place = centre_in_link(robot_, i) - Vector3d(0.5 * robot_.module_length_m, 0, 0);
    xml_.line(1, R"(<joint name="{}" type="revolute">)", joint_name(i));
    xml_.line(2, R"(<parent link="{}"/>)", link_name(i));
    xml_.line(2, R"(<child link="{}"/>)", link_name(i + 1));
    xml_.line(2, R"(<origin xyz="{}" rpy="0 0 0"/>)", text_of(place));
    xml_.line(2, R"(<axis xyz="{}"/>)", text_of(joint_axis_of_link(joint.axis)));
    xml_.line(2, R"(<limit lower="{}" upper="{}" effort="{}" velocity="{}"/>)", joint.min_rad, joint.max_rad,
              joint.max_torque_nm, joint.max_speed_rad_s);
    xml_.line(2, R"(<dynamics damping="0" friction="{}"/>)", joint.gear_friction_nm);
    xml_.line(1, "</joint>");
  }

  void camera(const CameraModel& camera, const std::string& joint) {
    const Eigen::Isometry3d X_LC = camera_in_link(robot_, camera);
    xml_.line(1, R"(<link name="{}"/>)", camera_frame(camera));
    xml_.line(1, R"(<joint name="{}" type="fixed">)", joint);
    xml_.line(2, R"(<parent link="{}"/>)", link_name(camera.module));
    xml_.line(2, R"(<child link="{}"/>)", camera_frame(camera));
    xml_.line(2, R"(<origin xyz="{}" rpy="{}"/>)", text_of(X_LC.translation()), text_of(rpy_of(X_LC.linear())));
    xml_.line(1, "</joint>");
  }

  const RobotModel& robot_;
  std::string mesh_;
  XmlText xml_;
};

class SdfWriter {
 public:
  SdfWriter(const RobotModel& robot, const std::string& mesh, double tick_s)
      : robot_(robot), mesh_(xml_escaped(mesh)), tick_s_(tick_s) {}

  std::string write() {
    xml_.line(0, R"(<?xml version="1.0"?>)");
    xml_.line(0, "<!-- Written by `constrictor robot export`. Units: m, kg, s, N, rad. -->");
    xml_.line(0, R"(<sdf version="1.9">)");
    xml_.line(1, R"(<model name="{}">)", xml_escaped(robot_.name));
    xml_.line(2, "<pose>0 0 {} 0 0 0</pose>", robot_.module_radius_m);
    frame(robot_.camera);
    for (const CameraModel& camera : robot_.further_cameras) frame(camera);
    for (std::size_t i = 0; i < robot_.module_count; ++i) link(i);
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) joint(i);
    xml_.line(1, "</model>");
    xml_.line(0, "</sdf>");
    return xml_.take();
  }

 private:
  void frame(const CameraModel& camera) {
    xml_.line(2, R"(<frame name="{}" attached_to="{}"><pose>{}</pose></frame>)", camera_frame(camera),
              link_name(camera.module), pose_text(camera_in_link(robot_, camera)));
  }

  void link(std::size_t i) {
    const Vector3d centre = centre_in_link(robot_, i);
    const ModuleInertia inertia = module_inertia(robot_);
    const double x_m = -robot_.module_length_m * static_cast<double>(i) - centre.x();
    xml_.line(2, R"(<link name="{}">)", link_name(i));
    xml_.line(3, "<pose>{} 0 0 0 0 0</pose>", x_m);
    xml_.line(3, "<inertial>");
    xml_.line(4, "<pose>{} 0 0 0</pose>", text_of(centre));
    xml_.line(4, "<mass>{}</mass>", robot_.module_mass_kg);
    xml_.line(4, "<inertia><ixx>{0}</ixx><iyy>{1}</iyy><izz>{1}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>",
              inertia.along_kg_m2, inertia.across_kg_m2);
    xml_.line(3, "</inertial>");
    for (const char* use : {"visual", "collision"}) {
      xml_.line(3, R"(<{0} name="{0}">)", use);
      const bool meshed = !mesh_.empty() && use == std::string("visual");
      xml_.line(4, "<pose>{} 0 {} 0</pose>", text_of(centre), meshed ? 0.0 : kLie_rad);
      if (meshed) {
        xml_.line(4, "<geometry><mesh><uri>{}</uri></mesh></geometry>", mesh_);
      } else {
        xml_.line(4, "<geometry><capsule><radius>{}</radius><length>{}</length></capsule></geometry>",
                  robot_.module_radius_m, robot_.module_length_m);
      }
      if (use == std::string("collision")) skin();
      xml_.line(3, "</{}>", use);
    }
    if (i == 0) camera(robot_.camera, "camera");
    for (const CameraModel& further : robot_.further_cameras) {
      if (further.module == i) camera(further, "camera_" + further.name);
    }
    xml_.line(2, "</link>");
  }

  /// The first direction of friction is the z axis of the capsule: along the module.
  void skin() {
    xml_.line(4, "<surface><friction><ode><mu>{}</mu><mu2>{}</mu2><fdir1>0 0 1</fdir1></ode></friction></surface>",
              robot_.friction_along, robot_.friction_across);
  }

  void joint(std::size_t i) {
    const JointModel& joint = robot_.joints[i];
    xml_.line(2, R"(<joint name="{}" type="revolute">)", joint_name(i));
    xml_.line(3, "<parent>{}</parent>", link_name(i));
    xml_.line(3, "<child>{}</child>", link_name(i + 1));
    xml_.line(3, "<axis>");
    xml_.line(4, "<xyz>{}</xyz>", text_of(joint_axis_of_link(joint.axis)));
    xml_.line(4, "<limit><lower>{}</lower><upper>{}</upper><effort>{}</effort><velocity>{}</velocity></limit>",
              joint.min_rad, joint.max_rad, joint.max_torque_nm, joint.max_speed_rad_s);
    xml_.line(4, "<dynamics><damping>0</damping><friction>{}</friction></dynamics>", joint.gear_friction_nm);
    xml_.line(3, "</axis>");
    xml_.line(2, "</joint>");
  }

  /// A camera of SDF looks along x, its z axis points up in the image.
  void camera(const CameraModel& camera, const std::string& name) {
    Eigen::Isometry3d X_LSensor = camera_in_link(robot_, camera);
    const Eigen::Matrix3d R_LC = X_LSensor.linear();
    X_LSensor.linear() << R_LC.col(2), -R_LC.col(0), -R_LC.col(1);
    xml_.line(3, R"(<sensor name="{}" type="camera">)", name);
    xml_.line(4, "<pose>{}</pose>", pose_text(X_LSensor));
    xml_.line(4, "<always_on>true</always_on>");
    xml_.line(4, "<update_rate>{}</update_rate>", 1.0 / (camera.period_ticks * tick_s_));
    xml_.line(4, "<camera>");
    xml_.line(5, "<horizontal_fov>{}</horizontal_fov>", camera.horizontal_fov_rad);
    xml_.line(5, "<image><width>{}</width><height>{}</height><format>R8G8B8</format></image>", camera.width,
              camera.height);
    xml_.line(5, "<clip><near>0.01</near><far>100</far></clip>");
    xml_.line(4, "</camera>");
    xml_.line(3, "</sensor>");
  }

  const RobotModel& robot_;
  std::string mesh_;
  double tick_s_;
  XmlText xml_;
};

}  // namespace

std::string joint_name(std::size_t joint) { return fmt::format("joint_{:02}", joint); }
std::string link_name(std::size_t module) { return module == 0 ? "base_link" : fmt::format("module_{:02}", module); }

std::string camera_frame(const CameraModel& camera) {
  return camera.name.empty() ? kCameraFrame : fmt::format("camera_{}_optical", camera.name);
}

Eigen::Isometry3d camera_in_link(const RobotModel& robot, const CameraModel& camera) {
  Eigen::Isometry3d X_LC = camera_mount(camera);
  X_LC.translation() += centre_in_link(robot, camera.module);
  return X_LC;
}

Vector3d centre_in_link(const RobotModel& robot, std::size_t module) {
  return {module == 0 ? 0.0 : -0.5 * robot.module_length_m, 0, 0};
}

Vector3d joint_axis_of_link(JointAxis axis) {
  return axis == JointAxis::kYaw ? Vector3d(0, 0, -1) : Vector3d(0, -1, 0);
}

ModuleInertia module_inertia(const RobotModel& robot) {
  const double r = robot.module_radius_m;
  const double length = robot.module_length_m;
  // Masses of the cylinder and of both caps together, by their shares of the volume.
  const double cylinder_kg = robot.module_mass_kg * length / (length + 4.0 / 3.0 * r);
  const double caps_kg = robot.module_mass_kg - cylinder_kg;
  ModuleInertia inertia;
  inertia.along_kg_m2 = cylinder_kg * r * r / 2 + caps_kg * 2 * r * r / 5;
  inertia.across_kg_m2 = cylinder_kg * (length * length / 12 + r * r / 4) +
                         caps_kg * (2 * r * r / 5 + length * length / 4 + 3 * length * r / 8);
  return inertia;
}

std::string urdf_model(const RobotModel& robot, const std::string& mesh) { return UrdfWriter(robot, mesh).write(); }
std::string sdf_model(const RobotModel& robot, const std::string& mesh, double tick_s) {
  return SdfWriter(robot, mesh, tick_s).write();
}

}  // namespace constrictor
