#include "perception/line_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace constrictor::perception {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMaxSteps = 400;
constexpr int kMaxSeeds = 6;
constexpr double kMinLength_m = 0.06;

enum class Seen { kGround, kLine, kStanding, kOutside };

enum class Section { kGood, kOneEdge, kNothing, kHidden, kOutside };

Eigen::Vector2d left_of(const Eigen::Vector2d& d) { return {-d.y(), d.x()}; }

class Tracer {
 public:
  Tracer(const cv::Mat& labels, const Regions& regions, const GroundCamera& camera, const PerceptionConfig& config,
         std::uint8_t colour)
      : labels_(labels), regions_(regions), camera_(camera), config_(config), colour_(colour),
        width_m_(config.line_width_m) {}

  LineTrace run() {
    collect_pixels();
    for (int attempt = 0; attempt < kMaxSeeds && !pixels_.empty(); ++attempt) {
      const Eigen::Vector2d seed = pixels_.front();
      LineTrace trace = trace_from(seed);
      if (!trace.points.empty()) return trace;
      std::erase_if(pixels_, [&](const Eigen::Vector2d& p) { return (p - seed).norm() < 0.12; });
    }
    return {};
  }

 private:
  /// Ground points of the line's colour, nearest first.
  void collect_pixels() {
    for (int v = labels_.rows - 1; v >= 0; --v) {
      const std::uint8_t* row = labels_.ptr<std::uint8_t>(v);
      const int stride = 2;
      for (int u = v % stride; u < labels_.cols; u += stride) {
        if (row[u] != colour_ || is_standing(u, v)) continue;
        if (const auto p = camera_.ground(u + 0.5, v + 0.5, config_.line_max_range_m)) pixels_.push_back(*p);
      }
    }
    std::stable_sort(pixels_.begin(), pixels_.end(),
                     [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  }

  [[nodiscard]] bool is_standing(int u, int v) const {
    const std::uint8_t id = regions_.ids.at<std::uint8_t>(v, u);
    if (id == 0) return false;
    const Region& region = regions_.regions[id - 1u];
    if (!region.standing() || region.area == 0) return false;
    // an object of the line's own colour is told from the line before it by its width
    return region.colour != colour_ || (u >= region.standing_first - 1 && u <= region.standing_last + 1 &&
                                        v <= region.standing_bottom + 1 + (region.standing_last - region.standing_first) / 6);
  }

  [[nodiscard]] Seen look(const Eigen::Vector2d& p) const {
    const auto pixel = camera_.pixel(p);
    if (!pixel || !camera_.inside(*pixel)) return Seen::kOutside;
    const int u = static_cast<int>(pixel->x()), v = static_cast<int>(pixel->y());
    if (is_standing(u, v) || camera_.own_head(pixel->x(), pixel->y())) return Seen::kStanding;
    return labels_.at<std::uint8_t>(v, u) == colour_ ? Seen::kLine : Seen::kGround;
  }

  [[nodiscard]] double range(const Eigen::Vector2d& p) const { return (p - camera_.position_on_ground()).norm(); }

  /// [m] size on the ground of a pixel at `p` in a direction.
  [[nodiscard]] double pixel_size_m(const Eigen::Vector2d& p, const Eigen::Vector2d& direction) const {
    const Eigen::Vector2d sight = p - camera_.position_on_ground();
    const double r = std::max(sight.norm(), 1e-3);
    const double along = std::abs(sight.dot(direction)) / r;
    return along * camera_.pixel_along_m(r) + (1.0 - along) * camera_.pixel_across_m(r);
  }

  /// Looks across the course at `p`; on success `centre` is the line's, [m] to the left of p. `slack_m` is how much farther
  /// from the course than usual it may lie.
  Section cross_section(const Eigen::Vector2d& p, const Eigen::Vector2d& direction, double slack_m,
                        double& centre) const {
    const Eigen::Vector2d n = left_of(direction);
    const double pixel_m = pixel_size_m(p, n);
    const double step_m = std::clamp(0.4 * pixel_m, 0.001, 0.02);
    const double reach_m = std::max(1.6 * width_m_, 3.0 * pixel_m) + 0.5 * width_m_ + slack_m;
    const int half = static_cast<int>(std::ceil(reach_m / step_m));
    std::vector<Seen>& seen = seen_;
    seen.assign(static_cast<std::size_t>(2 * half + 1), Seen::kGround);
    int outside = 0, standing = 0;
    for (int i = -half; i <= half; ++i) {
      const Seen s = look(p + i * step_m * n);
      seen[static_cast<std::size_t>(i + half)] = s;
      if (std::abs(i) * step_m < 0.5 * width_m_) {
        outside += s == Seen::kOutside ? 1 : 0;
        standing += s == Seen::kStanding ? 1 : 0;
      }
    }
    const int hole = std::max(1, static_cast<int>(std::lround(1.2 * pixel_m / step_m)));
    const int fringe = static_cast<int>(std::lround(4.0 * pixel_m / step_m));
    const double blur_m = 1.5 * pixel_m;

    Section best = standing > 0 ? Section::kHidden : outside > 0 ? Section::kOutside : Section::kNothing;
    double best_distance = 0.75 * width_m_ + 2.0 * pixel_m + slack_m;
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
      if (run_m > 2.0 * width_m_ + blur_m) continue;
      double middle = 0.5 * (left_m + right_m);
      Section kind = Section::kGood;
      if (right_open && left_open) {
        if (run_m < 0.5 * width_m_ - blur_m) continue;
      } else if (right_open) {
        middle = right_m + 0.5 * width_m_ + (run_m > width_m_ ? 0.5 * (run_m - width_m_) : 0.0);
        kind = Section::kOneEdge;
      } else if (left_open) {
        middle = left_m - 0.5 * width_m_ - (run_m > width_m_ ? 0.5 * (run_m - width_m_) : 0.0);
        kind = Section::kOneEdge;
      } else {
        continue;
      }
      if (std::abs(middle) < best_distance) {
        best_distance = std::abs(middle);
        best = kind;
        centre = middle;
        run_m_ = run_m;
      }
    }
    return best;
  }

  /// Whether ground lies beyond an edge, not the image's border nor something that hides the line.
  [[nodiscard]] bool edge_is_open(int index, int step, int fringe) const {
    for (int k = 1; k <= fringe; ++k) {
      const int at = index + k * step;
      if (at < 0 || at >= static_cast<int>(seen_.size())) return true;
      const Seen s = seen_[static_cast<std::size_t>(at)];
      if (s == Seen::kStanding || (k <= 2 && s == Seen::kOutside)) return false;
    }
    return true;
  }

  struct Walk {
    std::vector<LineTrace::Point> points;
    Section stopped_by = Section::kNothing;
    Eigen::Vector2d direction;
    bool hidden_in_gap = false;
    bool left_view_in_gap = false;
  };

  Walk walk(Eigen::Vector2d p, Eigen::Vector2d direction) {
    Walk w;
    double gap_m = 0.0;
    for (int i = 0; i < kMaxSteps; ++i) {
      const double step_m = std::clamp(0.05 * range(p), 0.012, 0.05);
      if (i > 0) p += step_m * direction;
      // farther away than it can be resolved the line fades without an end
      if (p.norm() > config_.line_max_range_m || pixel_size_m(p, left_of(direction)) > 0.9 * width_m_) {
        w.stopped_by = Section::kOutside;
        break;
      }
      double centre = 0.0;
      const Section section = cross_section(p, direction, 0.2 * gap_m, centre);
      if (section == Section::kGood || section == Section::kOneEdge) {
        const Eigen::Vector2d found = p + centre * left_of(direction);
        // a line found again behind a gap must lie on the course
        if (gap_m > 0.0 && std::abs(centre) > 0.02 + 0.35 * gap_m) {
          w.stopped_by = Section::kNothing;
          break;
        }
        const double sd_m = (section == Section::kGood ? 0.3 : 0.8) * pixel_size_m(found, left_of(direction)) + 0.001;
        if (section == Section::kGood && width_samples_ < 40) {
          // the line's own width, from where both edges are clear
          ++width_samples_;
          width_m_ += (run_m_ - width_m_) / (width_samples_ + 3.0);
        }
        w.points.push_back({found, sd_m});
        p = found;
        direction = course(w.points, direction);
        gap_m = 0.0;
        w.hidden_in_gap = w.left_view_in_gap = false;
      } else {
        gap_m += step_m;
        w.hidden_in_gap |= section == Section::kHidden;
        w.left_view_in_gap |= section == Section::kOutside;
        w.stopped_by = section;
        if (gap_m > config_.line_max_gap_m || section == Section::kOutside) break;
      }
    }
    w.direction = direction;
    return w;
  }

  /// Direction over the last points, long enough to be steady.
  [[nodiscard]] Eigen::Vector2d course(const std::vector<LineTrace::Point>& points, const Eigen::Vector2d& before) const {
    const Eigen::Vector2d& tip = points.back().p;
    const double base_m = std::max(0.08, 6.0 * points.back().sd_m);
    for (std::size_t i = points.size() - 1; i-- > 0;) {
      const Eigen::Vector2d chord = tip - points[i].p;
      if (chord.norm() >= base_m || i == 0) {
        if (chord.norm() < 0.4 * base_m) return before;
        const Eigen::Vector2d direction = chord.normalized();
        return direction.dot(before) > 0.3 ? direction : before;
      }
    }
    return before;
  }

  /// Direction through the seed in which the line's colour reaches farthest.
  [[nodiscard]] Eigen::Vector2d first_direction(const Eigen::Vector2d& seed) const {
    Eigen::Matrix2d best_scatter = Eigen::Matrix2d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    double weight = 0.0;
    const double radius_m = std::max(0.15, 1.5 * range(seed) * 0.3);
    for (int pass = 0; pass < 2; ++pass) {
      for (const Eigen::Vector2d& p : pixels_) {
        if ((p - seed).norm() > radius_m) continue;
        const double r = range(p);
        const double area = r * camera_.pixel_along_m(r);  // of the pixel on the ground, but for a factor
        if (pass == 0) {
          mean += area * p;
          weight += area;
        } else {
          best_scatter += area * (p - mean) * (p - mean).transpose();
        }
      }
      if (pass == 0 && weight > 0.0) mean /= weight;
    }
    const double angle =
        0.5 * std::atan2(2.0 * best_scatter(0, 1), best_scatter(0, 0) - best_scatter(1, 1));
    return {std::cos(angle), std::sin(angle)};
  }

  LineTrace trace_from(const Eigen::Vector2d& seed) {
    width_m_ = config_.line_width_m;
    width_samples_ = 0;
    const Eigen::Vector2d guess = first_direction(seed);
    // the principal axis first; a stub that is cut by the image may be broader than long
    for (const double turn : {0.0, 0.5 * kPi, 0.25 * kPi, -0.25 * kPi}) {
      Eigen::Vector2d direction(std::cos(turn) * guess.x() - std::sin(turn) * guess.y(),
                                std::sin(turn) * guess.x() + std::cos(turn) * guess.y());
      if (direction.x() < 0.0) direction = -direction;
      double centre = 0.0;
      Eigen::Vector2d start = seed;
      const Section section = cross_section(start, direction, 0.0, centre);
      if (section == Section::kGood || section == Section::kOneEdge) start += centre * left_of(direction);
      LineTrace trace = join(walk(start, direction), walk(start, -direction));
      if (!trace.points.empty()) return trace;
    }
    return {};
  }

  /// Both walks as one line, near to far; empty if it is too short.
  [[nodiscard]] LineTrace join(const Walk& ahead, const Walk& back) const {
    LineTrace trace;
    std::size_t clear = ahead.points.size() + back.points.size();
    if (clear < 4) return {};
    for (std::size_t i = back.points.size(); i-- > 1;) trace.points.push_back(back.points[i]);
    trace.points.insert(trace.points.end(), ahead.points.begin(), ahead.points.end());
    double length_m = 0.0;
    for (std::size_t i = 1; i < trace.points.size(); ++i) length_m += (trace.points[i].p - trace.points[i - 1].p).norm();
    if (length_m < kMinLength_m) return {};
    const Walk* far = &ahead;
    if (trace.points.back().p.x() < trace.points.front().p.x()) {
      std::reverse(trace.points.begin(), trace.points.end());
      far = &back;
    }
    find_end(*far, trace);
    return trace;
  }

  /// The line ends in view if bare ground follows its last point for some pixels and nothing hides it.
  void find_end(const Walk& far, LineTrace& trace) const {
    if (far.points.empty() || far.hidden_in_gap || far.stopped_by != Section::kNothing) {
      // leaving the view only matters if it happens at once
      if (far.points.empty() || far.hidden_in_gap || !far.left_view_in_gap) return;
    }
    const Eigen::Vector2d tip = far.points.back().p;
    const double pixel_m = pixel_size_m(tip, far.direction);
    if (pixel_size_m(tip, left_of(far.direction)) > 0.7 * width_m_) return;  // it may only have faded
    const double step_m = std::max(0.25 * pixel_m, 0.002);
    Eigen::Vector2d last = tip;
    for (int i = 1; i < 200; ++i) {
      const Eigen::Vector2d p = tip + i * step_m * far.direction;
      if ((p - last).norm() > std::max(0.06, 5.0 * pixel_m)) break;
      const Seen s = look(p);
      if (s == Seen::kOutside || s == Seen::kStanding || p.norm() > config_.line_max_range_m) return;
      if (s == Seen::kLine) last = p;
    }
    // a bend that was missed shows by the line's colour near the tip but off the traced course
    const double stray_m = 1.5 * width_m_ + 2.0 * pixel_m;
    for (const Eigen::Vector2d& p : pixels_) {
      if ((p - tip).norm() > 0.4) continue;
      const bool traced = std::any_of(trace.points.begin(), trace.points.end(), [&](const LineTrace::Point& point) {
        return (p - point.p).norm() < stray_m;
      });
      if (!traced) return;
    }
    trace.end_visible = true;
    trace.end = last;
  }

  const cv::Mat& labels_;
  const Regions& regions_;
  const GroundCamera& camera_;
  const PerceptionConfig& config_;
  std::uint8_t colour_;
  double width_m_;
  int width_samples_ = 0;
  std::vector<Eigen::Vector2d> pixels_;
  mutable std::vector<Seen> seen_;
  mutable double run_m_ = 0.0;
};

}  // namespace

LineTrace trace_line(const cv::Mat& labels, const Regions& regions, const GroundCamera& camera,
                     const PerceptionConfig& config, std::uint8_t colour) {
  return Tracer(labels, regions, camera, config, colour).run();
}

}  // namespace constrictor::perception
