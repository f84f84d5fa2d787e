// Motions of the simulated robot whose results the step of the solver must not change.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/validation/gait_run.hpp"
#include "bench/validation/planar_model.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

/// Mean energy of the swing between two indices, as a share of the energy of the amplitude.
double mean_energy(const Swing& swing, std::size_t from, std::size_t to, double whole_j) {
  double sum_j = 0.0;
  for (std::size_t i = from; i < to; ++i) sum_j += swing.energy_j[i];
  return sum_j / (static_cast<double>(to - from) * whole_j);
}

TEST(SimulatedMotion, AHeadThatSwingsOnARobotOnTheGroundKeepsPeriodAndEnergy) {
  constexpr double kAmplitude_rad = 1.2;
  const RobotModel robot = mamba();
  const double lever_m = 0.5 * robot.module_length_m;  // from the pivot to the centre of mass
  const double moment_nm = robot.module_mass_kg * kG * lever_m;
  const double inertia_kg_m2 = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m) +
                               robot.module_mass_kg * lever_m * lever_m + kSwingingRotor_kg_m2;
  const double period_s =
      4.0 * std::sqrt(inertia_kg_m2 / moment_nm) * std::comp_ellint_1(std::sin(0.5 * kAmplitude_rad));
  const SolverSettings settings;
  const Swing swing = swing_head(kAmplitude_rad, 3.0, settings);
  EXPECT_NEAR(swing.period_s(), period_s, 0.002 * period_s);

  const double whole_j = moment_nm * (1.0 - std::cos(kAmplitude_rad));
  const auto span = static_cast<std::size_t>(std::lround(period_s / settings.step_s));
  const std::size_t last = swing.energy_j.size();
  EXPECT_NEAR(mean_energy(swing, last - span, last, whole_j), mean_energy(swing, 0, span, whole_j), 0.01);
}

// The whole engine, not the law of a contact alone: with an ellipse as the bound on the friction, the gait moves and
// works as in the planar model, which shares no code with it.
TEST(SimulatedMotion, WithEllipticFrictionTheGaitAgreesWithThePlanarModel) {
  const RobotModel robot = mamba();
  const LateralUndulation gait;
  SolverSettings elliptic;
  elliptic.elliptic_friction = true;
  const PlanarModel model(planar_robot(robot, FrictionPlaces::kModuleEnds),
                          {FrictionLaw::kEllipse, robot.friction_along, robot.friction_across});
  const PlanarMeasurement planar = measure_planar(model, gait, 3, 2);
  const GaitMeasurement simulated = measure_gait(robot, lateral_gait(robot, gait), elliptic, 3);
  EXPECT_NEAR(simulated.speed_m_s, planar.speed_m_s, 0.03 * planar.speed_m_s);
  EXPECT_NEAR(simulated.friction_j / simulated.duration_s, planar.power_w, 0.03 * planar.power_w);
}

// The points that touch the ground do not slip across the body in this gait. The forces with which they hold each other
// depend on how exactly each contact follows its module's axis within a step.
TEST(SimulatedMotion, TheStepHardlyChangesSpeedAndTorqueOfAGaitThatDoesNotSlip) {
  const RobotModel robot = mamba();
  const Gait gait = lateral_gait(robot, {});
  SolverSettings fine;
  fine.step_s = 0.0005;
  const GaitMeasurement usual = measure_gait(robot, gait);
  const GaitMeasurement reference = measure_gait(robot, gait, fine);
  EXPECT_NEAR(usual.speed_m_s, reference.speed_m_s, 0.005 * reference.speed_m_s);
  EXPECT_NEAR(usual.torque_rms_nm, reference.torque_rms_nm, 0.02 * reference.torque_rms_nm);
}

}  // namespace
}  // namespace constrictor::validation
