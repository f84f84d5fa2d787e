// The motion of a chain that touches objects compared with the solution of the whole system of equations.
#include "sim/world/chain_system.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace constrictor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep_s = 0.004;

/// Three modules and two objects. The last module touches the first object, which touches the second one; all contacts
/// are without friction and remain pressed, so that the equations are linear.
class ChainSystemWithObjects : public ::testing::Test {
 protected:
  ChainSystemWithObjects() {
    system_.bodies().resize(5);
    jacobians_.assign(5, MatrixXd::Zero(6, kSize));
    for (std::size_t b = 0; b < 5; ++b) {
      const MatrixXd root = random(6, 6);
      system_.bodies()[b].inertia = 0.1 * root * root.transpose() + 0.1 * Matrix6d::Identity();
      system_.bodies()[b].impulse = 0.01 * random(6, 1);
    }
    for (std::size_t b = 0; b < 3; ++b) jacobians_[b].leftCols<6>().setIdentity();
    for (std::size_t j = 0; j < 2; ++j) {
      system_.joints()[j].axis = random(6, 1);
      for (std::size_t b = j + 1; b < 3; ++b) jacobians_[b].col(static_cast<Index>(6 + j)) = system_.joints()[j].axis;
    }
    for (std::size_t b = 3; b < 5; ++b) jacobians_[b].middleCols<6>(b == 3 ? 8 : 14).setIdentity();
    for (const auto& [first, second] : {std::pair{2, 3}, std::pair{3, 4}}) {
      SolverContact contact;
      contact.touch.normal = Vector3d::UnitZ();
      contact.touch.depth_m = 0.003;
      contact.friction = Friction::equal(0.0);
      system_.contacts().push_back({static_cast<std::size_t>(first), static_cast<std::size_t>(second), random(6, 3),
                                    random(6, 3), ContactLaw(contact, settings_)});
    }
  }

  MatrixXd random(Index rows, Index columns) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator_); });
  }

  /// The velocities at the end of the step, with k depth - d v as the force of a contact.
  VectorXd solution() {
    MatrixXd matrix = MatrixXd::Zero(kSize, kSize);
    VectorXd right = VectorXd::Zero(kSize);
    for (std::size_t b = 0; b < 5; ++b) {
      matrix += jacobians_[b].transpose() * system_.bodies()[b].inertia * jacobians_[b];
      right += jacobians_[b].transpose() * system_.bodies()[b].impulse;
    }
    const double pressed_n = settings_.contact_stiffness_n_m * (0.003 - settings_.surface_layer_m);
    for (const ChainSystem::Contact& contact : system_.contacts()) {
      const VectorXd normal = jacobians_[contact.first].transpose() * contact.on_first.col(0) -
                              jacobians_[contact.second].transpose() * contact.on_second.col(0);
      matrix += kStep_s * settings_.contact_damping_n_s_m * normal * normal.transpose();
      right += kStep_s * pressed_n * normal;
    }
    return matrix.ldlt().solve(right);
  }

  static constexpr Index kSize = 20;
  std::mt19937 generator_{7};
  SolverSettings settings_;
  ChainSystem system_{3};
  std::vector<MatrixXd> jacobians_;
};

TEST_F(ChainSystemWithObjects, MovesAsTheWholeSystemOfEquationsSays) {
  const VectorXd expected = solution();
  const std::array<std::size_t, 2> objects{3, 4}, contacts{0, 1};
  EXPECT_EQ(system_.solve(true, objects, contacts, kStep_s), 1) << "linear equations need one iteration";
  for (std::size_t b = 0; b < 5; ++b)
    EXPECT_LT((system_.bodies()[b].velocity - jacobians_[b] * expected).norm(), 1e-9 * expected.norm()) << "body " << b;
  for (std::size_t j = 0; j < 2; ++j)
    EXPECT_NEAR(system_.joints()[j].rate_rad_s, expected[static_cast<Index>(6 + j)], 1e-9 * expected.norm());
  for (const ChainSystem::Contact& contact : system_.contacts())
    EXPECT_GT(contact.force_n[0], 0.0) << "the contact is not pressed, so that the equations are not those of the test";
}

}  // namespace
}  // namespace constrictor
