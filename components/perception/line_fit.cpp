#include "perception/line_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "configuration/quantiles.hpp"

namespace constrictor::perception {
namespace {

constexpr double kHalfWindow_m = 0.40;  // of the line on either side of the lookahead
constexpr double kCurvaturePrior_1_m = 1.5;
constexpr int kIterations = 4;

/// The traced line as a function of its length, and the place where it passes the lookahead distance.
std::size_t anchor_index(const LineTrace& trace, double lookahead_m, double& reached_m) {
  const auto& points = trace.points;
  std::size_t best = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double a = points[i].p.x() - lookahead_m, b = points[i + 1].p.x() - lookahead_m;
    if ((a <= 0.0) != (b <= 0.0)) {
      reached_m = lookahead_m;
      return std::abs(a) < std::abs(b) ? i : i + 1;
    }
    if (std::abs(b) < std::abs(points[best].p.x() - lookahead_m)) best = i + 1;
  }
  reached_m = points[best].p.x();
  return best;
}

}  // namespace

LineFit LineFitter::fit(const LineTrace& trace, double lookahead_m) {
  LineFit fit;
  const auto& points = trace.points;
  if (points.size() < 4) return fit;
  const std::size_t anchor = anchor_index(trace, lookahead_m, fit.lookahead_m);

  // The part of the line around the anchor.
  std::size_t first = anchor, last = anchor;
  double behind_m = 0.0, ahead_m = 0.0;
  while (first > 0 && behind_m < kHalfWindow_m) {
    behind_m += (points[first].p - points[first - 1].p).norm();
    --first;
  }
  while (last + 1 < points.size() && ahead_m < kHalfWindow_m) {
    ahead_m += (points[last + 1].p - points[last].p).norm();
    ++last;
  }
  if (last - first < 3) return fit;

  // A frame along the line at the anchor. It is turned once more after the first fit.
  const Eigen::Vector2d origin = points[anchor].p;
  Eigen::Vector2d t =
      (points[std::min(last, anchor + 3)].p - points[anchor >= first + 3 ? anchor - 3 : first].p).normalized();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int turn = 0; turn < 2; ++turn) {
    const Eigen::Vector2d n(-t.y(), t.x());
    weight_.assign(last - first + 1, 1.0);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      A(2, 2) = 4.0 / (kCurvaturePrior_1_m * kCurvaturePrior_1_m);
      for (std::size_t i = first; i <= last; ++i) {
        const Eigen::Vector2d d = points[i].p - origin;
        const double s = d.dot(t), y = d.dot(n);
        const Eigen::Vector3d row(1.0, s, s * s);
        const double w = weight_[i - first] / (points[i].sd_m * points[i].sd_m);
        A += w * row * row.transpose();
        b += w * y * row;
      }
      A(0, 0) += 1e-9;
      A(1, 1) += 1e-9;
      c = A.ldlt().solve(b);
      // Tukey's biweight of residuals in units of their expected error.
      residual_.resize(weight_.size());
      for (std::size_t i = first; i <= last; ++i) {
        const Eigen::Vector2d d = points[i].p - origin;
        const double s = d.dot(t);
        residual_[i - first] = std::abs(d.dot(n) - (c[0] + c[1] * s + c[2] * s * s)) / points[i].sd_m;
      }
      sorted_ = residual_;
      const double scale = std::max(1.5, 1.48 * upper_median(sorted_)) * 4.7;
      for (std::size_t i = 0; i < weight_.size(); ++i) {
        const double r = residual_[i] / scale;
        weight_[i] = r < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
      }
    }
    if (turn == 0) {
      const Eigen::Vector2d turned = (t + c[1] * n).normalized();
      if (turned.dot(t) > 0.3) t = turned;
    }
  }

  // Newton's method finds where the parabola passes x = lookahead, from the anchor.
  const Eigen::Vector2d n(-t.y(), t.x());
  double s = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double x = origin.x() + s * t.x() + (c[0] + c[1] * s + c[2] * s * s) * n.x();
    const double slope = t.x() + (c[1] + 2.0 * c[2] * s) * n.x();
    if (std::abs(slope) < 0.2) {
      s = 0.0;
      break;
    }
    s = std::clamp(s + (fit.lookahead_m - x) / slope, -0.1, 0.1);
  }
  const double y = c[0] + c[1] * s + c[2] * s * s, slope = c[1] + 2.0 * c[2] * s;
  const Eigen::Vector2d at = origin + s * t + y * n;
  const Eigen::Vector2d along = t + slope * n;
  fit.lookahead_m = at.x();
  fit.offset_m = at.y();
  fit.heading_rad = std::atan2(along.y(), along.x());
  fit.curvature_1_m = 2.0 * c[2] / std::pow(1.0 + slope * slope, 1.5);
  fit.valid = std::isfinite(fit.offset_m) && std::isfinite(fit.heading_rad) && std::isfinite(fit.curvature_1_m);
  return fit;
}

}  // namespace constrictor::perception
