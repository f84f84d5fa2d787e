// Why the simulated robot is faster than published ones: one cause after the other.
#include <cmath>

#include "bench/validation/checks.hpp"
#include "bench/validation/gait_run.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

struct Variant {
  std::string name;
  RobotModel robot;
  OpenLoopGait gait;
};

RobotModel with_friction(double along, double across) {
  RobotModel robot = mamba();
  robot.friction_along = along;
  robot.friction_across = across;
  return robot;
}

OpenLoopGait gait_of(double frequency_hz, double amplitude_rad = OpenLoopGait{}.amplitude_rad) {
  OpenLoopGait gait;
  gait.frequency_hz = frequency_hz;
  gait.amplitude_rad = amplitude_rad;
  return gait;
}

std::vector<Variant> variants() {
  const RobotModel mx106 = robot_file("mamba_mx106");
  RobotModel servo = mamba();
  servo.joints = mx106.joints;
  return {
      {"mamba, the gait of navigation (0.7 Hz, amplitude 0.5 rad)", mamba(), gait_of(0.7)},
      {"mamba at 0.3 Hz", mamba(), gait_of(0.3)},
      {"mamba with the servos of mamba_mx106", servo, gait_of(0.7)},
      {"mamba with friction 0.1 along, 0.5 across (ratio 5)", with_friction(0.1, 0.5), gait_of(0.7)},
      {"mamba with the friction of a snake on cloth: 0.11 along, 0.2 across (ratio 1.8)", with_friction(0.11, 0.2),
       gait_of(0.7)},
      {"the same with an amplitude of 0.9 rad", with_friction(0.11, 0.2), gait_of(0.7, 0.9)},
      {"mamba_mx106, the gait of navigation", mx106, gait_of(0.7)},
      {"mamba_mx106 at 0.3 Hz", mx106, gait_of(0.3)},
      {"serpens, the gait of navigation", robot_file("serpens"), gait_of(0.7)},
  };
}

}  // namespace

Section check_speeds() {
  Section section{
      "Speeds of the robot files",
      "The gait that navigation uses, on several robots. \"Body lengths\" divides the speed by the length of "
      "the robot (2.14 m); \"way per wave\" divides the way in one period by the length of the wave along the "
      "ground, and would be 1 for a body that follows its own track without slip.",
      {},
      {},
      {}};
  Table table{"Speed and its causes:",
              {"robot and gait", "speed [m/s]", "body lengths per second", "way per wave", "rms torque [Nm]",
               "tracking error [rad]"},
              {}};
  for (const Variant& variant : variants()) {
    const Gait gait = open_loop_gait(variant.robot, variant.gait);
    const GaitMeasurement found = measure_gait(variant.robot, gait, {}, 4, 4);
    const double length_m = 24 * variant.robot.module_length_m;
    table.rows.push_back({variant.name, shown(found.speed_m_s), shown(found.speed_m_s / length_m),
                          shown(found.speed_m_s * gait.period_s / variant.gait.wavelength_m),
                          shown(found.torque_rms_nm), shown(found.tracking_rad)});
    if (variant.name == "mamba_mx106 at 0.3 Hz")
      section.cases.push_back(
          {"mamba_mx106 at 0.3 Hz: between 0.05 and 0.25 m/s", "m/s", 0.15, found.speed_m_s, 0.1, false});
  }
  section.tables.push_back(table);
  return section;
}

}  // namespace constrictor::validation
