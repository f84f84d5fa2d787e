// The elimination of a chain compared with Eigen's Cholesky factorisation of the whole matrix.
#include "sim/world/chain_factor.hpp"

#include <gtest/gtest.h>

#include <random>

namespace constrictor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A chain with random joints and random positive definite matrices of its modules, some of which are much stiffer than
/// the others, as modules on the ground are.
struct RandomChain {
  RandomChain(std::size_t modules, unsigned seed) : stiffness(modules), joints(modules - 1), generator(seed) {
    for (std::size_t k = 0; k < modules; ++k) {
      const MatrixXd root = random(6, 6);
      stiffness[k] = root * root.transpose() + 0.1 * Matrix6d::Identity();
      if (k % 3 == 0) stiffness[k] *= 1e3;
    }
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = {random(6, 1), j % 2 == 0 ? 0.0 : 5.0};
  }

  MatrixXd random(Index rows, Index columns) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
  }

  /// The matrix by its definition: module k has the velocity J_k x.
  [[nodiscard]] MatrixXd matrix() const {
    const auto size = static_cast<Index>(6 + joints.size());
    MatrixXd sum = MatrixXd::Zero(size, size);
    MatrixXd jacobian = MatrixXd::Zero(6, size);
    jacobian.leftCols<6>().setIdentity();
    for (std::size_t k = 0; k < stiffness.size(); ++k) {
      if (k > 0) jacobian.col(static_cast<Index>(5 + k)) = joints[k - 1].axis;
      sum += jacobian.transpose() * stiffness[k] * jacobian;
    }
    for (std::size_t j = 0; j < joints.size(); ++j)
      sum(static_cast<Index>(6 + j), static_cast<Index>(6 + j)) += joints[j].slope;
    return sum;
  }

  std::vector<Matrix6d> stiffness;
  std::vector<ChainFactor::Joint> joints;
  std::mt19937 generator;
};

TEST(ChainFactor, SolvesAsCholeskyDoesForTheWholeMatrix) {
  ChainFactor factor;
  for (const std::size_t modules : {1, 2, 3, 24, 60}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(::testing::Message() << modules << " modules, seed " << seed);
      RandomChain chain(modules, seed);
      const Eigen::LLT<MatrixXd> whole(chain.matrix());
      const auto size = static_cast<Index>(5 + modules);
      factor.compute(chain.stiffness, chain.joints);

      VectorXd x = chain.random(size, 1);
      const VectorXd expected = whole.solve(x);
      factor.solve(x);
      EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());

      MatrixXd six = chain.random(6, size);
      const MatrixXd expected_six = whole.solve(six.transpose()).transpose();
      factor.solve_six(six);
      EXPECT_LT((six - expected_six).norm(), 1e-9 * expected_six.norm());
    }
  }
}

}  // namespace
}  // namespace constrictor
