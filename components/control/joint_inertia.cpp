#include "control/joint_inertia.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "robot/description.hpp"

namespace constrictor {

using Eigen::MatrixXd;
using Eigen::VectorXd;

JointInertia::JointInertia(const RobotModel& robot, std::vector<std::size_t> joints, double mass_share)
    : joints_(std::move(joints)) {
  const double module_kg = mass_share * robot.module_mass_kg;
  const auto n = static_cast<Eigen::Index>(joints_.size());
  VectorXd modules(n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    const std::size_t end = i < n ? joints_[static_cast<std::size_t>(i)] + 1 : robot.module_count;
    const std::size_t begin = i > 0 ? joints_[static_cast<std::size_t>(i - 1)] + 1 : 0;
    modules(i) = static_cast<double>(end - begin);
  }
  const VectorXd mass = module_kg * modules;
  const VectorXd length = robot.module_length_m * modules;
  const double module_kg_m2 = mass_share * module_inertia(robot).across_kg_m2;
  own_kg_m2_.resize(n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    // Modules at equal distances in a row: the sum of (k - mean)^2 is m (m^2 - 1) / 12.
    const double spread = modules(i) * (modules(i) * modules(i) - 1.0) / 12.0;
    own_kg_m2_(i) = modules(i) * module_kg_m2 + module_kg * spread * robot.module_length_m * robot.module_length_m;
  }
  // The centre of link i relative to the front end of the body is the sum of place(i, j) times the direction of link j.
  MatrixXd place = MatrixXd::Zero(n + 1, n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) place(i, j) = -length(j);
    place(i, i) = -0.5 * length(i);
  }
  const Eigen::RowVectorXd centre = modules.transpose() * place / modules.sum();
  place.rowwise() -= centre;
  coupling_kg_m2_ = place.transpose() * mass.asDiagonal() * place;
  rotor_kg_m2_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i)
    rotor_kg_m2_(i) = robot.joints[joints_[static_cast<std::size_t>(i)]].rotor_inertia_kg_m2;
}

MatrixXd JointInertia::matrix(const VectorXd& angle_rad) const {
  const Eigen::Index n = angle_rad.size();
  VectorXd heading = VectorXd::Zero(n + 1);
  for (Eigen::Index i = 0; i < n; ++i) heading(i + 1) = heading(i) - angle_rad(i);
  MatrixXd links = own_kg_m2_.asDiagonal();
  for (Eigen::Index j = 0; j <= n; ++j) {
    for (Eigen::Index k = 0; k <= n; ++k) links(j, k) += coupling_kg_m2_(j, k) * std::cos(heading(j) - heading(k));
  }
  MatrixXd difference = MatrixXd::Zero(n, n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    difference(i, i) = 1.0;
    difference(i, i + 1) = -1.0;
  }
  const MatrixXd mobility = difference * links.ldlt().solve(difference.transpose());
  MatrixXd inertia = mobility.ldlt().solve(MatrixXd::Identity(n, n));
  inertia.diagonal() += rotor_kg_m2_;
  return inertia;
}

}  // namespace constrictor
