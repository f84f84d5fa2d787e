#include "guidance/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace constrictor::guidance {
namespace {

constexpr double kLeastScale = 0.3, kMostScale = 1.7;  // a percept of something else must not turn the robot round

}  // namespace

Eigen::Matrix3d PoseFilter::pose_covariance() const { return covariance().topLeftCorner<3, 3>(); }

Eigen::Vector2d PoseFilter::landmark(std::size_t index) const { return mean().segment<2>(at(index)); }

Eigen::Matrix2d PoseFilter::landmark_covariance(std::size_t index) const {
  return covariance().block<2, 2>(at(index), at(index));
}

double PoseFilter::scale_sd() const { return std::sqrt(covariance()(kScale, kScale)); }

Eigen::Vector2d PoseFilter::predict(const Eigen::Vector2d& step_m, double turn_rad, const Eigen::Matrix3d& noise,
                                    const ScaledDrift& drift) {
  const double yaw = state_.mean[2] + 0.5 * turn_rad;  // in the middle of the step
  Eigen::Vector2d scaled_m = step_m + (state_.mean[kScale] - 1.0) * drift.step_m;
  const Eigen::Vector2d step = turned(scaled_m, yaw), drifted = turned(drift.step_m, yaw);
  const double keep = 1.0 - drift.forget;
  state_.mean[0] += step.x();
  state_.mean[1] += step.y();
  state_.mean[2] = wrap_angle_by_shift(state_.mean[2] + turn_rad);
  state_.mean[kScale] = 1.0 + keep * (state_.mean[kScale] - 1.0);

  Matrix F = Matrix::Identity(size(), size());
  F(0, 2) = -step.y();
  F(1, 2) = step.x();
  F.block<2, 1>(0, kScale) = drifted;
  F(kScale, kScale) = keep;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  const Matrix P = F * covariance() * F.transpose();
  covariance() = P;
  covariance().topLeftCorner<3, 3>() += G * noise * G.transpose();
  covariance()(kScale, kScale) += (1.0 - keep * keep) * drift.scale_sd * drift.scale_sd;
  return scaled_m;
}

void PoseFilter::forget_scale(double sd) {
  state_.mean[kScale] = 1.0;
  covariance().row(kScale).setZero();
  covariance().col(kScale).setZero();
  covariance()(kScale, kScale) = sd * sd;
}

void PoseFilter::observation(std::size_t index, Matrix& H, Eigen::Vector2d& expected) const {
  const double c = std::cos(state_.mean[2]), s = std::sin(state_.mean[2]);
  Eigen::Matrix2d R_t;
  R_t << c, s, -s, c;
  expected = pose().to_local(landmark(index));
  H = Matrix::Zero(2, size());
  H.leftCols<2>() = -R_t;
  H(0, 2) = expected.y();
  H(1, 2) = -expected.x();
  H.block<2, 2>(0, at(index)) = R_t;
}

PoseFilter::Match PoseFilter::match(std::size_t index, const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise) const {
  Matrix H;
  Eigen::Vector2d expected;
  observation(index, H, expected);
  const Eigen::Matrix2d S = H * covariance() * H.transpose() + noise;
  const Eigen::Vector2d innovation = z_m - expected;
  const auto factors = S.ldlt();
  return {innovation.dot(factors.solve(innovation)), factors.vectorD().array().log().sum()};
}

void PoseFilter::observe(std::size_t index, const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise) {
  Matrix H;
  Eigen::Vector2d expected;
  observation(index, H, expected);
  correct(H, z_m - expected, noise);
}

void PoseFilter::correct(const Matrix& H, const Vector& innovation, const Matrix& noise) {
  const Matrix P = covariance();
  const Matrix S = H * P * H.transpose() + noise;
  const Matrix K = S.ldlt().solve(H * P).transpose();
  const Vector change = K * innovation;
  if (!change.allFinite()) return;
  mean() += change;
  state_.mean[2] = wrap_angle_by_shift(state_.mean[2]);
  state_.mean[kScale] = std::clamp(state_.mean[kScale], kLeastScale, kMostScale);
  // Joseph's form keeps the covariance symmetric and positive.
  const Matrix I_KH = Matrix::Identity(size(), size()) - K * H;
  covariance() = I_KH * P * I_KH.transpose() + K * noise * K.transpose();
}

void PoseFilter::add(const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise) {
  const Eigen::Index n = size();
  const double c = std::cos(state_.mean[2]), s = std::sin(state_.mean[2]);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  const Eigen::Vector2d arm = R * z_m;
  Matrix G = Matrix::Zero(2, n);
  G.leftCols<2>().setIdentity();
  G(0, 2) = -arm.y();
  G(1, 2) = arm.x();
  const Matrix P = covariance();
  Matrix grown(n + 2, n + 2);
  grown.topLeftCorner(n, n) = P;
  grown.bottomLeftCorner(2, n) = G * P;
  grown.topRightCorner(n, 2) = (G * P).transpose();
  grown.bottomRightCorner(2, 2) = G * P * G.transpose() + R * noise * R.transpose();
  state_.mean.push_back(state_.mean[0] + arm.x());
  state_.mean.push_back(state_.mean[1] + arm.y());
  state_.covariance.assign(grown.data(), grown.data() + grown.size());
}

void PoseFilter::remove(std::size_t index) {
  const Eigen::Index n = size(), from_row = at(index), behind = n - from_row - 2;
  const Matrix P = covariance();
  Matrix left(n - 2, n - 2);
  left.topLeftCorner(from_row, from_row) = P.topLeftCorner(from_row, from_row);
  left.topRightCorner(from_row, behind) = P.topRightCorner(from_row, behind);
  left.bottomLeftCorner(behind, from_row) = P.bottomLeftCorner(behind, from_row);
  left.bottomRightCorner(behind, behind) = P.bottomRightCorner(behind, behind);
  const auto from = state_.mean.begin() + static_cast<std::ptrdiff_t>(from_row);
  state_.mean.erase(from, from + 2);
  state_.covariance.assign(left.data(), left.data() + left.size());
}

void PoseFilter::loosen(std::size_t index, double variance_m2) {
  for (Eigen::Index i = at(index); i < at(index) + 2; ++i) {
    if (covariance()(i, i) < 0.25) covariance()(i, i) += variance_m2;
  }
}

void PoseFilter::observe_line(double residual_m, const Eigen::Vector2d& normal, const Eigen::Vector2d& arm_m,
                              double variance_m2) {
  Matrix H = Matrix::Zero(1, size());
  H(0, 0) = normal.x();
  H(0, 1) = normal.y();
  H(0, 2) = normal.dot(Eigen::Vector2d(-arm_m.y(), arm_m.x()));
  Vector innovation(1);
  innovation << -residual_m;
  Matrix noise(1, 1);
  noise << variance_m2;
  correct(H, innovation, noise);
}

}  // namespace constrictor::guidance
