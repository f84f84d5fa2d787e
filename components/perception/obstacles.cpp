#include "perception/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "configuration/quantiles.hpp"
#include "constrictor/messages.hpp"
#include "perception/sight.hpp"

namespace constrictor::perception {
namespace {

constexpr int kColumnStep = 2;       // [pixel]
constexpr std::size_t kColumns = 3;  // neighbouring columns that must agree
constexpr int kSustained = 3;        // pixels over which a change of shade must last
constexpr double kSpacing_m = 0.05;  // between the points of a surface
constexpr double kNearest_m = 0.12;  // nearer ground is hidden by the head in most attitudes
constexpr double kHighest_m = 2.0;
constexpr int kMargin = 3;  // [pixel] beside coloured things, where their border has mixed colours

/// A colour, as three channels of 0 to 255.
using Shade = std::array<double, 3>;

double difference(const Shade& a, const Shade& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Walks through the image from the horizon.
class Walk {
 public:
  Walk(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera, double least_difference)
      : rgb_(rgb), regions_(regions), camera_(camera), least_(least_difference) {}

  /// The shade at the horizon. None if something of a colour of interest, or the robot itself, is there.
  [[nodiscard]] std::optional<Shade> begin(const Eigen::Vector2d& horizon, const Eigen::Vector2d& down) const {
    Shade sum{};
    constexpr std::array kOffsets{-2, -1, 0, 1};
    for (const int offset : kOffsets) {
      const Eigen::Vector2d p = horizon + offset * down;
      if (!camera_.inside(p) || coloured(p) || camera_.own_body(p.x(), p.y())) return std::nullopt;
      const Shade shade = at(p);
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += shade[c] / kOffsets.size();
    }
    return sum;
  }

  /// Where a walk from `from` in `direction` leaves the shade, between the pixels. None if it does so at the border of
  /// the image, at the robot itself, or at something coloured that stands there.
  [[nodiscard]] std::optional<Eigen::Vector2d> end(const Eigen::Vector2d& from, const Eigen::Vector2d& direction,
                                                   const Shade& shade) const {
    int other = 0;
    for (int step = 1;; ++step) {
      const Eigen::Vector2d p = from + step * direction;
      if (!camera_.inside(p) || camera_.own_body(p.x(), p.y()) || stands(p)) return std::nullopt;
      other = difference(at(p), shade) > least_ ? other + 1 : 0;
      if (other == kSustained) return crossing(from, direction, step - kSustained, shade);
    }
  }

 private:
  [[nodiscard]] Shade at(const Eigen::Vector2d& p) const {
    // Interpolates between the centres of two rows.
    const double row = std::clamp(p.y() - 0.5, 0.0, rgb_.rows - 1.0);
    const int upper = static_cast<int>(row), lower = std::min(upper + 1, rgb_.rows - 1);
    const double part = row - upper;
    const auto* a = rgb_.ptr<std::uint8_t>(upper) + 3 * static_cast<int>(p.x());
    const auto* b = rgb_.ptr<std::uint8_t>(lower) + 3 * static_cast<int>(p.x());
    return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
  }
  [[nodiscard]] int region_at(const Eigen::Vector2d& p) const {
    return regions_.ids.at<std::uint8_t>(static_cast<int>(p.y()), static_cast<int>(p.x())) - 1;
  }
  [[nodiscard]] bool coloured(const Eigen::Vector2d& p) const {
    for (const double aside : {-1.0 * kMargin, 0.0, 1.0 * kMargin}) {
      const Eigen::Vector2d q = p + Eigen::Vector2d(aside, 0.0);
      if (camera_.inside(q) && region_at(q) >= 0) return true;
    }
    return false;
  }
  [[nodiscard]] bool stands(const Eigen::Vector2d& p) const {
    const int region = region_at(p);
    return region >= 0 && regions_.regions[static_cast<std::size_t>(region)].standing();
  }
  /// The point at which half of the change is done that begins after `step` steps.
  [[nodiscard]] Eigen::Vector2d crossing(const Eigen::Vector2d& from, const Eigen::Vector2d& direction, int step,
                                         const Shade& shade) const {
    const double whole = difference(at(from + (step + kSustained) * direction), shade);
    double before = difference(at(from + step * direction), shade);
    for (int k = 1; k <= kSustained; ++k) {
      const double now = difference(at(from + (step + k) * direction), shade);
      if (now >= 0.5 * whole) {
        const double part = now > before ? std::clamp((0.5 * whole - before) / (now - before), 0.0, 1.0) : 0.5;
        return from + (step + k - 1 + part) * direction;
      }
      before = now;
    }
    return from + (step + kSustained) * direction;
  }

  const cv::Mat& rgb_;
  const Regions& regions_;
  const GroundCamera& camera_;
  double least_;
};

/// The foot of what hides the horizon in a column of the image, in V; none if nothing does.
std::optional<Eigen::Vector2d> foot_in_column(const Walk& walk, const GroundCamera& camera,
                                              const PerceptionConfig& config, double u) {
  const Eigen::Vector2d at_horizon(u, camera.horizon_row(u));
  if (!camera.inside(at_horizon)) return std::nullopt;
  const auto plane = vertical_plane(camera, azimuth_rad(camera, at_horizon));
  if (!plane) return std::nullopt;
  const auto shade = walk.begin(plane->horizon, plane->down);
  if (!shade) return std::nullopt;
  const auto foot = walk.end(plane->horizon, plane->down, *shade);
  if (!foot) return std::nullopt;
  auto p = camera.ground(foot->x(), foot->y(), config.obstacle_max_range_m);
  if (!p) return std::nullopt;
  const double range_m = (*p - camera.position_on_ground()).norm();
  if (range_m < kNearest_m) return std::nullopt;
  const auto top = walk.end(plane->horizon, -plane->down, *shade);
  if (!top) return std::nullopt;
  const double rise = -descent(camera, *top);
  if (rise < kHorizonErrorPixels / camera.focal_pixels() || range_m * rise > kHighest_m) return std::nullopt;
  return p;
}

/// The surface of an obstacle, by its feet in successive columns, seen from the camera.
class Surface {
 public:
  Surface(const GroundCamera& camera, Obstacles& found) : camera_(camera), found_(found) {}

  [[nodiscard]] bool continues_at(const Eigen::Vector2d& foot) const {
    // The depth of a surface that continues changes little from column to column.
    const double step_m = 2.0 * camera_.pixel_along_m(foot.norm()) + 0.1 * foot.norm();
    return columns_ == 0 || std::abs(feet_.back().norm() - foot.norm()) <= step_m;
  }
  void end() { columns_ = points_ = 0; }
  /// Adds a foot. The one before it gives a point, unless it is in an outer column: those show a mixture of the
  /// obstacle and of what lies behind it.
  void add(const Eigen::Vector2d& foot) {
    feet_ = {feet_[1], feet_[2], foot};
    if (++columns_ < kColumns || found_.full()) return;
    std::array ranges_m{feet_[0].norm(), feet_[1].norm(), feet_[2].norm()};
    const Eigen::Vector2d p = camera_.position_on_ground() + upper_median(ranges_m) * feet_[1].normalized();
    if (points_ > 0 && (p - last_).norm() < kSpacing_m) return;
    found_.push_back(p);
    last_ = p;
    ++points_;
  }

 private:
  const GroundCamera& camera_;
  Obstacles& found_;
  std::array<Eigen::Vector2d, kColumns> feet_{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                              Eigen::Vector2d::Zero()};  // the last ones
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();                       // of the points
  std::size_t columns_ = 0;
  std::size_t points_ = 0;
};

}  // namespace

Obstacles find_obstacles(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                         const PerceptionConfig& config) {
  Obstacles found;
  if (config.obstacle_max_range_m <= 0.0) return found;
  const Walk walk(rgb, regions, camera, 255.0 * config.obstacle_min_contrast);
  Surface surface(camera, found);
  for (int u = 0; u < camera.width(); u += kColumnStep) {
    const auto foot = foot_in_column(walk, camera, config, u + 0.5);
    if (!foot) {
      surface.end();
      continue;
    }
    const Eigen::Vector2d seen = *foot - camera.position_on_ground();
    if (!surface.continues_at(seen)) surface.end();
    surface.add(seen);
  }
  return found;
}

}  // namespace constrictor::perception
