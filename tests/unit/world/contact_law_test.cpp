// The law of a contact of ChainDynamics, compared with its own definition by finite differences and by geometry.
#include "sim/world/contact_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <random>
#include <utility>

namespace constrictor {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

SolverContact contact_at(double depth_m, const Friction& friction) {
  SolverContact contact;
  contact.touch.depth_m = depth_m;
  contact.friction = friction;
  contact.first = 0;
  return contact;
}

Friction skin() { return {0.05, 0.5, false, Vector3d(0.6, 0.8, 0.0)}; }

Matrix3d matrix_of(const ContactSlope& slope) {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t i = 0; i < slope.count; ++i)
    sum += slope.terms[i].slope * slope.terms[i].axis * slope.terms[i].axis.transpose();
  return sum;
}

TEST(ContactLaw, TheNormalForceIsThatOfASpringAndADamper) {
  SolverSettings settings;
  const double depth = 0.0004;
  for (const double step_s : {0.0005, 0.002, 0.005}) {  // the same at each step
    settings.step_s = step_s;
    const ContactLaw law(contact_at(settings.surface_layer_m + depth, Friction::equal(0.4)), settings);
    for (const double v : {-0.05, 0.0, 0.02}) {
      const double expected = settings.contact_stiffness_n_m * depth - settings.contact_damping_n_s_m * v;
      EXPECT_NEAR(law.force_n({v, 0.0, 0.0})[0], std::max(0.0, expected), 1e-9) << v;
    }
  }
  const ContactLaw law(contact_at(settings.surface_layer_m + depth, Friction::equal(0.4)), settings);
  EXPECT_EQ(law.force_n({1.0, 0.0, 0.0})[0], 0.0) << "bodies that separate do not pull each other";
}

TEST(ContactLaw, BodiesThatOverlapDeeplyPartSlowly) {
  const SolverSettings settings;
  const ContactLaw law(contact_at(0.035, Friction::equal(0.4)), settings);
  const double mass = 0.1;  // [kg] of a body that nothing else holds: m v = h f(v)
  double v = 0.0;
  for (int i = 0; i < 50; ++i) {
    double low = v, high = 100.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (mass * (middle - v) < settings.step_s * law.force_n({middle, 0.0, 0.0})[0] ? low : high) = middle;
    }
    v = low;
  }
  EXPECT_NEAR(v, settings.max_correcting_velocity_m_s, 0.1);
}

TEST(ContactLaw, SlidingFrictionOpposesTheVelocityWithinItsBound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> speed(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    const Vector3d v(-0.01, speed(random), speed(random));
    ContactLaw equal(contact_at(0.0012, Friction::equal(0.4)), {});
    equal.bound(v);
    const Vector3d force = equal.force_n(v);
    EXPECT_NEAR(force.tail<2>().norm(), 0.4 * force[0], 1e-9);  // the same in each direction
    EXPECT_NEAR(force.tail<2>().normalized().dot(v.tail<2>().normalized()), -1.0, 1e-9);
    ContactLaw scaled(contact_at(0.0012, skin()), {});
    scaled.bound(v);
    const Vector3d on_skin = scaled.force_n(v);
    EXPECT_NEAR(on_skin[1], std::copysign(0.05 * on_skin[0], -v[1]), 1e-9);
    EXPECT_NEAR(on_skin[2], std::copysign(0.5 * on_skin[0], -v[2]), 1e-9);
  }
}

// Coulomb's law with an ellipse: of all forces within the bound, the one of a sliding body takes the most power.
TEST(ContactLaw, SlidingSkinWithAnEllipseTakesTheMostPower) {
  SolverSettings settings;
  settings.elliptic_friction = true;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> speed(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    const Vector3d v(-0.01, speed(random), speed(random));
    ContactLaw law(contact_at(0.0012, skin()), settings);
    law.bound(v);
    const Vector3d force = law.force_n(v);
    EXPECT_NEAR(std::hypot(force[1] / 0.05, force[2] / 0.5), force[0], 1e-9) << "on the ellipse";
    for (double angle = 0.0; angle < 6.28; angle += 0.01) {
      const Vector3d other(0.0, 0.05 * force[0] * std::cos(angle), 0.5 * force[0] * std::sin(angle));
      EXPECT_GE(-force.tail<2>().dot(v.tail<2>()), -other.tail<2>().dot(v.tail<2>()) - 1e-9);
    }
  }
  // With equal coefficients the ellipse is the circle of isotropic friction.
  ContactLaw circle(contact_at(0.0012, {0.4, 0.4, false, Vector3d::UnitX()}), settings);
  ContactLaw equal(contact_at(0.0012, Friction::equal(0.4)), settings);
  for (const Vector3d& v : {Vector3d(0.0, 1e-6, 2e-6), Vector3d(0.0, 0.1, -0.2)}) {
    circle.bound(v);
    equal.bound(v);
    EXPECT_NEAR(circle.force_n(v).norm(), equal.force_n(v).norm(), 1e-9);
    EXPECT_NEAR((circle.frame() * circle.force_n(v)).dot(circle.frame() * v),
                (equal.frame() * equal.force_n(v)).dot(equal.frame() * v), 1e-9);
  }
}

TEST(ContactLaw, TheFirstTangentOfSkinIsTheDirectionAlongTheModule) {
  const ContactLaw law(contact_at(0.0012, skin()), {});
  EXPECT_LT((law.frame().col(1) - skin().direction).norm(), 1e-12);
  EXPECT_LT((law.frame().transpose() * law.frame() - Matrix3d::Identity()).norm(), 1e-12);
}

TEST(ContactLaw, TheSlopeIsTheDerivativeOfTheForce) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-7.0, 0.0);
  std::uniform_real_distribution<double> direction(-1.0, 1.0);
  SolverSettings elliptic;
  elliptic.elliptic_friction = true;
  for (const auto& [friction, settings] :
       {std::pair(Friction::equal(0.4), SolverSettings{}), {skin(), SolverSettings{}}, {skin(), elliptic}}) {
    for (int i = 0; i < 500; ++i) {
      const Vector3d v =
          std::pow(10.0, exponent(random)) * Vector3d(direction(random), direction(random), direction(random));
      ContactLaw law(contact_at(0.0012, friction), settings);
      law.bound(v);
      const Matrix3d slope = matrix_of(law.slope(v));
      Matrix3d found;
      const double h = 1e-4 * v.norm();
      for (int k = 0; k < 3; ++k) {
        const Vector3d to = h * Vector3d::Unit(k);
        found.col(k) = -(law.force_n(v + to) - law.force_n(v - to)) / (2.0 * h);
      }
      // A difference across the edge of sticking lies between the slopes on both sides of the edge.
      const bool smooth =
          (matrix_of(law.slope(v * 1.001)) - matrix_of(law.slope(v * 0.999))).norm() < 0.01 * slope.norm();
      if (!smooth) continue;
      EXPECT_LT((found - slope).norm(), 0.01 * slope.norm() + 1e-6) << v.transpose();
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix3d>(slope).eigenvalues().minCoeff(), -1e-9)
          << "the force never rises";
    }
  }
}

}  // namespace
}  // namespace constrictor
