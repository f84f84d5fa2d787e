#include "sim/world/chain_factor.hpp"

#include <cstddef>

namespace constrictor {

using Eigen::Index;

void ChainFactor::compute(std::span<const Matrix6d> stiffness, std::span<const Joint> joints) {
  joints_.resize(joints.size());
  Matrix6d behind = stiffness[joints.size()];
  for (std::size_t j = joints.size(); j-- > 0;) {
    Eliminated& joint = joints_[j];
    joint.axis = joints[j].axis;
    joint.coupling.noalias() = behind * joint.axis;
    joint.inverse = 1.0 / (joint.axis.dot(joint.coupling) + joints[j].slope);
    behind.noalias() -= (joint.inverse * joint.coupling) * joint.coupling.transpose();
    behind += stiffness[j];
  }
  root_.compute(behind);
}

template <class Rows>
void ChainFactor::solve_rows(Rows& rows) const {
  using Six = Eigen::Matrix<double, Rows::RowsAtCompileTime, 6>;
  Six sum = Six::Zero();  // of what the joints behind leave for the velocity ahead of them
  for (std::size_t j = joints_.size(); j-- > 0;) {
    const Eliminated& joint = joints_[j];
    auto b = rows.col(static_cast<Index>(6 + j));
    b.noalias() += sum * joint.axis;
    sum.noalias() -= (joint.inverse * b) * joint.coupling.transpose();
  }
  Six velocity = rows.template leftCols<6>() + sum;
  velocity = root_.solve(velocity.transpose()).transpose().eval();
  rows.template leftCols<6>() = velocity;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Eliminated& joint = joints_[j];
    auto x = rows.col(static_cast<Index>(6 + j));
    x = joint.inverse * (x - velocity * joint.coupling);
    velocity.noalias() += x * joint.axis.transpose();
  }
}

void ChainFactor::solve(Eigen::Ref<Eigen::VectorXd> b) const {
  auto row = b.transpose();
  solve_rows(row);
}

void ChainFactor::solve_six(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> b) const { solve_rows(b); }

}  // namespace constrictor
