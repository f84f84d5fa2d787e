#include "perception/line_view.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor::perception {

std::vector<Eigen::Vector2d> LineView::line_points(double max_range_m) const {
  struct Found {
    double distance2_m2;
    std::size_t index;  // the order in which they were found decides between points of the same distance
  };
  if (colour_ >= labels_.extents.size()) return {};
  const ColourExtent& extent = labels_.extents[colour_];
  std::vector<Found> found;
  std::vector<Eigen::Vector2d> points;
  found.reserve(static_cast<std::size_t>(extent.pixels) / 2 + 1);  // of the squares of a checkerboard; rarely more
  points.reserve(found.capacity());
  for (int v = extent.v_max; v >= extent.v_min; --v) {
    const std::uint8_t* row = labels_.image.ptr<std::uint8_t>(v);
    constexpr int kStride = 2;
    for (int u = extent.u_min + (extent.u_min + v) % kStride; u <= extent.u_max; u += kStride) {
      if (row[u] != colour_ || is_standing(u, v)) continue;
      if (const auto p = camera_.ground(u + 0.5, v + 0.5, max_range_m)) {
        found.push_back({p->squaredNorm(), found.size()});
        points.push_back(*p);
      }
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.distance2_m2 != b.distance2_m2 ? a.distance2_m2 < b.distance2_m2 : a.index < b.index;
  });
  std::vector<Eigen::Vector2d> sorted;
  sorted.reserve(found.size());
  for (const Found& f : found) sorted.push_back(points[f.index]);
  return sorted;
}

bool LineView::is_standing(int u, int v) const {
  const std::uint8_t id = regions_.ids.at<std::uint8_t>(v, u);
  if (id == 0) return false;
  const Region& region = regions_.regions[id - 1u];
  if (!region.standing() || region.area == 0) return false;
  // The width distinguishes an object of the line's own colour from the line in front of it.
  return region.colour != colour_ ||
         (u >= region.standing_first - 1 && u <= region.standing_last + 1 &&
          v <= region.standing_bottom + 1 + (region.standing_last - region.standing_first) / 6);
}

Seen LineView::look(const Eigen::Vector2d& p) const {
  const auto pixel = camera_.pixel(p);
  if (!pixel || !camera_.inside(*pixel)) return Seen::kOutside;
  const int u = static_cast<int>(pixel->x()), v = static_cast<int>(pixel->y());
  if (is_standing(u, v) || camera_.own_body(pixel->x(), pixel->y())) return Seen::kStanding;
  const std::uint8_t label = labels_.image.at<std::uint8_t>(v, u);
  return label == colour_ ? Seen::kLine : label == kDazzled ? Seen::kStanding : Seen::kGround;
}

double LineView::pixel_size_m(const Eigen::Vector2d& p, const Eigen::Vector2d& direction) const {
  const Eigen::Vector2d sight = p - camera_.position_on_ground();
  const double r = std::max(sight.norm(), 1e-3);
  const double along = std::abs(sight.dot(direction)) / r;
  return along * camera_.pixel_along_m(r) + (1.0 - along) * camera_.pixel_across_m(r);
}

CrossSection LineView::cross_section(const Eigen::Vector2d& p, const Eigen::Vector2d& direction, double width_m,
                                     double slack_m) const {
  const Eigen::Vector2d n = left_of(direction);
  const double pixel_m = pixel_size_m(p, n);
  const double step_m = std::clamp(0.4 * pixel_m, 0.001, 0.02);
  const double reach_m = std::max(1.6 * width_m, 3.0 * pixel_m) + 0.5 * width_m + slack_m;
  const int half = static_cast<int>(std::ceil(reach_m / step_m));
  std::vector<Seen>& seen = seen_;
  seen.assign(static_cast<std::size_t>(2 * half + 1), Seen::kGround);
  int outside = 0, standing = 0;
  for (int i = -half; i <= half; ++i) {
    const Seen s = look(p + i * step_m * n);
    seen[static_cast<std::size_t>(i + half)] = s;
    if (std::abs(i) * step_m < 0.5 * width_m) {
      outside += s == Seen::kOutside ? 1 : 0;
      standing += s == Seen::kStanding ? 1 : 0;
    }
  }
  const int hole = std::max(1, static_cast<int>(std::lround(1.2 * pixel_m / step_m)));
  const int fringe = static_cast<int>(std::lround(4.0 * pixel_m / step_m));
  const double blur_m = 1.5 * pixel_m;

  CrossSection best;
  best.section = standing > 0 ? Section::kHidden : outside > 0 ? Section::kOutside : Section::kNothing;
  double best_distance = 0.75 * width_m + 2.0 * pixel_m + slack_m;
  const int count = static_cast<int>(seen.size());
  for (int i = 0; i < count; ++i) {
    if (seen[static_cast<std::size_t>(i)] != Seen::kLine) continue;
    int last = i;
    for (int j = i + 1; j < count && j <= last + hole; ++j) {
      if (seen[static_cast<std::size_t>(j)] == Seen::kLine) last = j;
    }
    const bool right_open = edge_is_open(i, -1, fringe), left_open = edge_is_open(last, 1, fringe);
    const double right_m = (i - half - 0.5) * step_m, left_m = (last - half + 0.5) * step_m;
    const double run_m = left_m - right_m;
    i = last;
    if (run_m > 2.0 * width_m + blur_m) continue;
    double middle = 0.5 * (left_m + right_m);
    Section kind = Section::kGood;
    if (right_open && left_open) {
      if (run_m < 0.5 * width_m - blur_m) continue;
    } else if (right_open) {
      middle = right_m + 0.5 * width_m + (run_m > width_m ? 0.5 * (run_m - width_m) : 0.0);
      kind = Section::kOneEdge;
    } else if (left_open) {
      middle = left_m - 0.5 * width_m - (run_m > width_m ? 0.5 * (run_m - width_m) : 0.0);
      kind = Section::kOneEdge;
    } else {
      continue;
    }
    if (std::abs(middle) < best_distance) {
      best_distance = std::abs(middle);
      best = {kind, middle, run_m};
    }
  }
  return best;
}

bool LineView::edge_is_open(int index, int step, int fringe) const {
  for (int k = 1; k <= fringe; ++k) {
    const int at = index + k * step;
    if (at < 0 || at >= static_cast<int>(seen_.size())) return true;
    const Seen s = seen_[static_cast<std::size_t>(at)];
    if (s == Seen::kStanding || (k <= 2 && s == Seen::kOutside)) return false;
  }
  return true;
}

}  // namespace constrictor::perception
