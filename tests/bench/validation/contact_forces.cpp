// The forces that the modules feel, against the weight that they carry.
#include <cmath>
#include <numbers>

#include "bench/validation/checks.hpp"
#include "bench/validation/gait_run.hpp"

namespace constrictor::validation {
namespace {

using Eigen::Vector3d;

Vector3d sum_of(const std::vector<Vector3d>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& force : forces) sum += force;
  return sum;
}

}  // namespace

Section check_contact_forces() {
  Section section{
      "Contact forces",
      "The sum of the forces on the skin is the weight of the robot: at rest, on a slope on which it holds, "
      "and on average while it moves. A straight body at rest carries itself evenly and does not creep.",
      {},
      {},
      {}};
  const RobotModel robot = mamba();
  const double module_n = robot.module_mass_kg * kG;
  const double weight_n = 24.0 * module_n;

  World resting(robot, Scenario{});
  hold(resting, 0.0, 6.0, 2.0);
  const std::vector<Vector3d> resting_n = module_forces_n(resting);
  section.cases.push_back({"at rest: sum of the vertical forces", "N", weight_n, sum_of(resting_n).z(), 0.001});
  section.cases.push_back(
      {"at rest: sum of the horizontal forces", "N", 0.0, sum_of(resting_n).head<2>().norm(), 0.01 * weight_n, false});
  double least_n = module_n;
  double most_n = module_n;
  for (const Vector3d& force : resting_n) {
    least_n = std::min(least_n, force.z());
    most_n = std::max(most_n, force.z());
  }
  section.cases.push_back({"at rest: least force on a module", "N", module_n, least_n, 0.05});
  section.cases.push_back({"at rest: greatest force on a module", "N", module_n, most_n, 0.05});
  // A body at rest neither creeps nor trembles.
  const Vector3d from_m = centre_of(resting);
  double rate_squares = 0.0;
  constexpr int kTicks = 100;
  for (int tick = 0; tick < kTicks; ++tick) {
    resting.advance(kPeriod_s);
    for (std::size_t i = 0; i < resting.joint_count(); ++i)
      rate_squares += std::pow(resting.joint_rate_rad_s(i), 2) / static_cast<double>(resting.joint_count() * kTicks);
  }
  section.cases.push_back(
      {"at rest: way of the body in 2 s", "mm", 0.0, 1e3 * (centre_of(resting) - from_m).norm(), 0.5, false});
  section.cases.push_back({"at rest: rms rate of the joints", "rad/s", 0.0, std::sqrt(rate_squares), 0.01, false});

  constexpr double kSlope_rad = 15.0 * std::numbers::pi / 180.0;
  Scenario scenario;
  scenario.gravity_m_s2 = kG * Vector3d(0.0, std::sin(kSlope_rad), -std::cos(kSlope_rad));
  World sloping(robot, scenario);
  hold(sloping, 0.0, 6.0, 2.0);
  const Vector3d sloping_n = sum_of(module_forces_n(sloping));
  section.cases.push_back({"across a slope of 15°: sum of the forces that press, m g cos a", "N",
                           weight_n * std::cos(kSlope_rad), sloping_n.z(), 0.001});
  section.cases.push_back({"across a slope of 15°: sum of the friction forces, m g sin a", "N",
                           -weight_n * std::sin(kSlope_rad), sloping_n.y(), 0.01});

  const GaitMeasurement moving = measure_gait(robot, lateral_gait(robot, {}));
  section.cases.push_back(
      {"moving: mean sum of the vertical forces over three cycles", "N", weight_n, moving.vertical_force_n, 0.005});
  return section;
}

Section check_gait_energy() {
  Section section{"Energy of the gait",
                  "Over whole cycles the motors do the work that friction takes; the body's energy does not grow. The "
                  "cost of transport is the work divided by weight and way.",
                  {},
                  {},
                  {}};
  Table table{"Power and cost of transport:",
              {"friction along / across", "period [s]", "speed [m/s]", "work of the motors [W]", "friction [W]",
               "cost of transport"},
              {}};
  for (const auto& [along, period_s] :
       {std::pair{0.05, 1.4}, std::pair{0.05, 2.0}, std::pair{0.1, 1.4}, std::pair{0.25, 1.4}}) {
    RobotModel robot = mamba();
    robot.friction_along = along;
    LateralUndulation gait;
    gait.frequency_hz = 1.0 / period_s;
    const GaitMeasurement found = measure_gait(robot, lateral_gait(robot, gait));
    section.cases.push_back({fmt::format("work of the motors minus growth of the kinetic energy; friction {} along, "
                                         "period {} s",
                                         along, period_s),
                             "J", found.friction_j, found.work_j - found.kinetic_change_j, 0.01});
    table.rows.push_back({fmt::format("{} / {}", along, robot.friction_across), shown(period_s), shown(found.speed_m_s),
                          shown(found.work_j / found.duration_s), shown(found.friction_j / found.duration_s),
                          shown(found.work_j / (24 * robot.module_mass_kg * kG * found.speed_m_s * found.duration_s))});
  }
  section.tables.push_back(table);
  return section;
}

}  // namespace constrictor::validation
