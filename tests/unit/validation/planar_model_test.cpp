// The planar model compared with the matrices of the book, with conservation laws and with the theory of swimming.
#include "bench/validation/planar_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "support/project.hpp"

namespace constrictor::validation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Equal links on which the ground acts in the middle.
PlanarRobot equal_links(Index links, double length_m, double mass_kg) {
  PlanarRobot robot{VectorXd::Constant(links, length_m),
                    VectorXd::Constant(links, mass_kg),
                    VectorXd::Constant(links, mass_kg * length_m * length_m / 12.0),
                    {}};
  for (Index i = 0; i < links; ++i) robot.points.push_back({i, 0.0, mass_kg * 9.81});
  return robot;
}

PlanarRobot mamba(FrictionPlaces places) { return planar_robot(load_robot(testing::robot_path("mamba")), places); }

double speed_m_s(const PlanarModel& model, const LateralUndulation& gait, int settle_cycles, int cycles,
                 double largest_step_s = 2e-4) {
  return measure_planar(model, gait, settle_cycles, cycles, largest_step_s).speed_m_s;
}

TEST(PlanarModel, HasTheMatricesOfTheBook) {
  constexpr Index kLinks = 6;
  constexpr double kHalf_m = 0.07;
  constexpr double kMass_kg = 0.8;
  const PlanarModel model(equal_links(kLinks, 2.0 * kHalf_m, kMass_kg), {});
  MatrixXd A = MatrixXd::Zero(kLinks - 1, kLinks);
  MatrixXd D = MatrixXd::Zero(kLinks - 1, kLinks);
  for (Index i = 0; i + 1 < kLinks; ++i) {
    A(i, i) = A(i, i + 1) = D(i, i) = 1.0;
    D(i, i + 1) = -1.0;
  }
  const MatrixXd inverse = (D * D.transpose()).inverse();
  const MatrixXd K = A.transpose() * inverse * D;
  const MatrixXd V = A.transpose() * inverse * A;
  EXPECT_NEAR((model.centre_matrix_m() - kHalf_m * K.transpose()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((model.coupling_matrix_kg_m2() - kMass_kg * kHalf_m * kHalf_m * V).norm(), 0.0, 1e-12);
}

TEST(PlanarModel, TheRobotHasShortLinksAtItsEndsAndItsWholeWeight) {
  const PlanarRobot robot = mamba(FrictionPlaces::kModuleEnds);
  ASSERT_EQ(robot.length_m.size(), 13);
  EXPECT_DOUBLE_EQ(robot.length_m[0], 0.089);
  EXPECT_DOUBLE_EQ(robot.length_m[6], 0.178);
  EXPECT_DOUBLE_EQ(robot.length_m[12], 0.089);
  EXPECT_NEAR(robot.mass_kg.sum(), 24 * 0.3, 1e-12);
  double weight_n = 0.0;
  for (const FrictionPoint& point : robot.points) weight_n += point.weight_n;
  EXPECT_NEAR(weight_n, 24 * 0.3 * 9.81, 1e-9);
}

TEST(PlanarModel, LinksOfTwoModulesMoveLikeTwoLinksWithAStraightJoint) {
  const PlanarRobot merged = mamba(FrictionPlaces::kModuleCentres);
  PlanarRobot split = equal_links(24, 0.089, 0.3);
  split.inertia_kg_m2.setConstant(merged.inertia_kg_m2[0]);
  const PlanarModel few(merged, {});
  const PlanarModel many(split, {});
  const JointMotion yaw = LateralUndulation{}.at(1.3, few.joint_count());
  JointMotion all{VectorXd::Zero(23), VectorXd::Zero(23), VectorXd::Zero(23)};
  for (Index k = 0; k < 12; ++k) {
    all.angle_rad[2 * k] = yaw.angle_rad[k];
    all.rate_rad_s[2 * k] = yaw.rate_rad_s[k];
    all.acceleration_rad_s2[2 * k] = yaw.acceleration_rad_s2[k];
  }
  const PlanarState state{0.2, {0.1, -0.3}, 0.7, {0.4, 0.1}};
  const PlanarModel::Instant a = few.evaluate(state, yaw);
  const PlanarModel::Instant b = many.evaluate(state, all);
  EXPECT_NEAR(a.turn_acceleration_rad_s2, b.turn_acceleration_rad_s2, 1e-9);
  EXPECT_NEAR((a.acceleration_m_s2 - b.acceleration_m_s2).norm(), 0.0, 1e-9);
  for (Index k = 0; k < 12; ++k) EXPECT_NEAR(a.torque_nm[k], b.torque_nm[2 * k], 1e-9);
  EXPECT_NEAR(a.kinetic_energy_j, b.kinetic_energy_j, 1e-12);
}

TEST(PlanarModel, KeepsMomentumAndEnergyWithoutFriction) {
  const PlanarModel model(mamba(FrictionPlaces::kModuleEnds), {FrictionLaw::kCoulomb, 0.0, 0.0});
  const LateralUndulation gait;
  const auto motion = [&](double t) { return gait.at(t, model.joint_count()); };
  PlanarState state;
  state.velocity_m_s = {0.3, -0.1};
  const double rest_j = model.evaluate(state, motion(0.0)).kinetic_energy_j;
  constexpr double kStep_s = 1e-3;
  double work_j = 0.0;
  double largest_turn = 0.0;
  for (int i = 0; i < 1500; ++i) {
    const double before_w = model.evaluate(state, motion(i * kStep_s)).joint_power_w;
    model.step(state, i * kStep_s, kStep_s, motion);
    const PlanarModel::Instant now = model.evaluate(state, motion((i + 1) * kStep_s));
    work_j += 0.5 * kStep_s * (before_w + now.joint_power_w);
    largest_turn = std::max(largest_turn, std::abs(state.turn_rad_s));
    ASSERT_NEAR(now.angular_momentum_nms, 0.0, 1e-9);
    ASSERT_NEAR(now.kinetic_energy_j - rest_j, work_j, 1e-5);
  }
  EXPECT_GT(largest_turn, 0.1);  // the body moves indeed
  EXPECT_NEAR((state.velocity_m_s - Eigen::Vector2d(0.3, -0.1)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((state.centre_m - 1.5 * Eigen::Vector2d(0.3, -0.1)).norm(), 0.0, 1e-9);
}

TEST(PlanarModel, TheJointsDoTheWorkThatFrictionTakes) {
  const PlanarModel model(mamba(FrictionPlaces::kModuleEnds), {});
  const LateralUndulation gait;
  const auto motion = [&](double t) { return gait.at(t, model.joint_count()); };
  PlanarState state;
  constexpr double kStep_s = 2e-4;
  double work_j = 0.0;
  double taken_j = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const PlanarModel::Instant before = model.evaluate(state, motion(i * kStep_s));
    model.step(state, i * kStep_s, kStep_s, motion);
    const PlanarModel::Instant after = model.evaluate(state, motion((i + 1) * kStep_s));
    work_j += 0.5 * kStep_s * (before.joint_power_w + after.joint_power_w);
    taken_j += 0.5 * kStep_s * (before.friction_power_w + after.friction_power_w);
  }
  const double kinetic_j = model.evaluate(state, motion(10000 * kStep_s)).kinetic_energy_j;
  EXPECT_GT(taken_j, 1.0);
  EXPECT_NEAR(work_j, taken_j + kinetic_j, 1e-3 * work_j);
}

TEST(PlanarModel, EqualFrictionInBothDirectionsDoesNotPropel) {
  const LateralUndulation gait;
  // Viscous friction with equal coefficients acts on the centre of mass like a single brake: it cannot start to move.
  const PlanarModel viscous(equal_links(8, 0.14, 0.5), {FrictionLaw::kViscous, 2.0, 2.0});
  EXPECT_NEAR(speed_m_s(viscous, gait, 1, 2, 1e-3), 0.0, 1e-12);
  // The bounds on Coulomb friction are a rectangle, so that equal coefficients leave a little anisotropy at its
  // corners.
  const PlanarModel equal(mamba(FrictionPlaces::kModuleEnds), {FrictionLaw::kCoulomb, 0.5, 0.5});
  const PlanarModel slippery(mamba(FrictionPlaces::kModuleEnds), {FrictionLaw::kCoulomb, 0.05, 0.5});
  EXPECT_LT(std::abs(speed_m_s(equal, gait, 2, 1)), 0.1 * speed_m_s(slippery, gait, 2, 1));
}

TEST(PlanarModel, SwimsAsFastAsResistiveForceTheorySays) {
  // Source: J. Gray, G. J. Hancock, "The propulsion of sea-urchin spermatozoa", J. Exp. Biol. 32 (1955): a long thin
  // body with waves of small slope A and wave speed V swims with U = V b (r - 1) / (1 + r b), b = A^2 / 2, where r is
  // the ratio of the viscous resistances across and along the body.
  constexpr double kLink_m = 0.05;
  constexpr double kSlope = 0.25;
  LateralUndulation gait;
  gait.frequency_hz = 1.0;
  gait.phase_offset_rad = std::numbers::pi / 6.0;  // five waves on 60 links
  gait.amplitude_rad = 2.0 * kSlope * std::sin(0.5 * gait.phase_offset_rad);
  const double wave_m_s = gait.frequency_hz * 12.0 * kLink_m * (1.0 - 0.25 * kSlope * kSlope);
  const double b = 0.5 * kSlope * kSlope;
  for (const double ratio : {2.0, 5.0}) {
    const PlanarModel model(equal_links(60, kLink_m, 0.002), {FrictionLaw::kViscous, 0.2, 0.2 * ratio});
    const double expected = wave_m_s * b * (ratio - 1.0) / (1.0 + ratio * b);
    EXPECT_NEAR(speed_m_s(model, gait, 1, 1, 2e-3), expected, 0.05 * expected) << ratio;
  }
}

}  // namespace
}  // namespace constrictor::validation
