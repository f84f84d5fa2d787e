// Solves the equations of a chain without the matrix of the whole chain. It eliminates one joint after the other, in a
// time that grows linearly with the number of modules.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/world/spatial.hpp"

namespace constrictor {

/// Solves A x = b for the unknowns of a chain, six of its first module and one for each joint. A is the matrix of the
/// quadratic form
///   sum over modules of v_k^T S_k v_k + sum over joints of d_j x_j^2,  v_k = v_(k-1) + a_k x_k
/// which is positive definite if the matrices S_k are and no d_j is negative. From the last joint to the first one, the
/// joint's unknown is expressed by the velocity ahead of it. What remains is a matrix of six by six numbers, which is
/// added to that of the module ahead, as if both were one body. Source: R. Featherstone, Rigid Body Dynamics
/// Algorithms, chapter 7 (the articulated-body algorithm, with S_k in place of inertias and d_j in place of rotors).
class ChainFactor {
 public:
  struct Joint {
    Vector6d axis = Vector6d::Zero();  ///< a: the spatial velocity of the modules behind the joint at a rate of 1
    double slope = 0.0;                ///< d
  };

  /// `stiffness` has the matrix S of each module, all about one point of reference; there is one joint less.
  void compute(std::span<const Matrix6d> stiffness, std::span<const Joint> joints);

  /// Replaces b by x.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const;
  /// The same for six right-hand sides, each of which is a row.
  void solve_six(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> b) const;

 private:
  struct Eliminated {
    Vector6d axis;
    Vector6d coupling;  ///< of the joint's unknown with the velocity ahead
    double inverse;     ///< of the joint's own entry
  };

  template <class Rows>
  void solve_rows(Rows& rows) const;

  std::vector<Eliminated> joints_;
  Eigen::LLT<Matrix6d> root_;
};

}  // namespace constrictor
