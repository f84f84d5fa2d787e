#include "perception/line_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "perception/line_view.hpp"

namespace constrictor::perception {
namespace {

constexpr int kMaxSteps = 400;
constexpr std::size_t kUsualSteps = 128;  // of most walks, so that the memory of their points is allocated once
constexpr int kMaxSeeds = 6;
constexpr double kMinLength_m = 0.06;

class Tracer {
 public:
  Tracer(const Labels& labels, const Regions& regions, const GroundCamera& camera, const PerceptionConfig& config,
         std::uint8_t colour)
      : view_(labels, regions, camera, colour), camera_(camera), config_(config), width_m_(config.line_width_m) {}

  LineTrace run() {
    pixels_ = view_.line_points(config_.line_max_range_m);
    for (int attempt = 0; attempt < kMaxSeeds && !pixels_.empty(); ++attempt) {
      const Eigen::Vector2d seed = pixels_.front();
      LineTrace trace = trace_from(seed);
      if (!trace.points.empty()) return trace;
      std::erase_if(pixels_, [&](const Eigen::Vector2d& p) { return (p - seed).norm() < 0.12; });
    }
    return {};
  }

 private:
  struct Walk {
    std::vector<LineTrace::Point> points;
    Section stopped_by = Section::kNothing;
    Eigen::Vector2d direction;
    bool hidden_in_gap = false;
    bool left_view_in_gap = false;
  };

  Walk walk(Eigen::Vector2d p, Eigen::Vector2d direction) {
    Walk w;
    w.points.reserve(kUsualSteps);
    double gap_m = 0.0;
    for (int i = 0; i < kMaxSteps; ++i) {
      const double step_m = std::clamp(0.05 * view_.range(p), 0.012, 0.05);
      if (i > 0) p += step_m * direction;
      // Beyond the distance at which it can be resolved, the line fades; that is not an end.
      if (p.norm() > config_.line_max_range_m || view_.pixel_size_m(p, left_of(direction)) > 0.9 * width_m_) {
        w.stopped_by = Section::kOutside;
        break;
      }
      const auto [section, centre, run_m] = view_.cross_section(p, direction, width_m_, 0.2 * gap_m);
      if (section == Section::kGood || section == Section::kOneEdge) {
        const Eigen::Vector2d found = p + centre * left_of(direction);
        // A line that is found again behind a gap must lie on the course.
        if (gap_m > 0.0 && std::abs(centre) > 0.02 + 0.35 * gap_m) {
          w.stopped_by = Section::kNothing;
          break;
        }
        const double sd_m =
            (section == Section::kGood ? 0.3 : 0.8) * view_.pixel_size_m(found, left_of(direction)) + 0.001;
        if (section == Section::kGood && width_samples_ < 40) {
          // The width of the line is measured where both edges are clear.
          ++width_samples_;
          width_m_ += (run_m - width_m_) / (width_samples_ + 3.0);
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

  /// Direction of the last points, over a length that makes it steady.
  [[nodiscard]] Eigen::Vector2d course(const std::vector<LineTrace::Point>& points,
                                       const Eigen::Vector2d& before) const {
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

  /// Direction through the seed in which the colour of the line extends farthest.
  [[nodiscard]] Eigen::Vector2d first_direction(const Eigen::Vector2d& seed) const {
    Eigen::Matrix2d best_scatter = Eigen::Matrix2d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    double weight = 0.0;
    const double radius_m = std::max(0.15, 1.5 * view_.range(seed) * 0.3);
    for (int pass = 0; pass < 2; ++pass) {
      for (const Eigen::Vector2d& p : pixels_) {
        if ((p - seed).norm() > radius_m) continue;
        const double r = view_.range(p);
        const double area = r * camera_.pixel_along_m(r);  // of the pixel on the ground, up to a constant factor
        if (pass == 0) {
          mean += area * p;
          weight += area;
        } else {
          best_scatter += area * (p - mean) * (p - mean).transpose();
        }
      }
      if (pass == 0 && weight > 0.0) mean /= weight;
    }
    const double angle = 0.5 * std::atan2(2.0 * best_scatter(0, 1), best_scatter(0, 0) - best_scatter(1, 1));
    return {std::cos(angle), std::sin(angle)};
  }

  LineTrace trace_from(const Eigen::Vector2d& seed) {
    width_m_ = config_.line_width_m;
    width_samples_ = 0;
    const Eigen::Vector2d guess = first_direction(seed);
    // The principal axis comes first, then others: a short piece that the image cuts may be wider than long.
    for (const double turn : {0.0, 0.5 * std::numbers::pi, 0.25 * std::numbers::pi, -0.25 * std::numbers::pi}) {
      Eigen::Vector2d direction(std::cos(turn) * guess.x() - std::sin(turn) * guess.y(),
                                std::sin(turn) * guess.x() + std::cos(turn) * guess.y());
      if (direction.x() < 0.0) direction = -direction;
      Eigen::Vector2d start = seed;
      const auto [section, centre, run_m] = view_.cross_section(start, direction, width_m_, 0.0);
      if (section == Section::kGood || section == Section::kOneEdge) start += centre * left_of(direction);
      LineTrace trace = join(walk(start, direction), walk(start, -direction));
      if (!trace.points.empty()) return trace;
    }
    return {};
  }

  /// Joins both walks to one line, from near to far; empty if the line is too short.
  [[nodiscard]] LineTrace join(const Walk& ahead, const Walk& back) const {
    LineTrace trace;
    std::size_t clear = ahead.points.size() + back.points.size();
    if (clear < 4) return {};
    trace.points.reserve(clear);
    for (std::size_t i = back.points.size(); i-- > 1;) trace.points.push_back(back.points[i]);
    trace.points.insert(trace.points.end(), ahead.points.begin(), ahead.points.end());
    double length_m = 0.0;
    for (std::size_t i = 1; i < trace.points.size(); ++i)
      length_m += (trace.points[i].p - trace.points[i - 1].p).norm();
    if (length_m < kMinLength_m) return {};
    const Walk* far = &ahead;
    if (trace.points.back().p.x() < trace.points.front().p.x()) {
      std::reverse(trace.points.begin(), trace.points.end());
      far = &back;
    }
    find_end(*far, trace);
    return trace;
  }

  /// The line ends in view if bare ground follows its last point for some pixels and nothing hides that place.
  void find_end(const Walk& far, LineTrace& trace) const {
    if (far.points.empty() || far.hidden_in_gap || far.stopped_by != Section::kNothing) {
      // Leaving the view matters only if it happens at once.
      if (far.points.empty() || far.hidden_in_gap || !far.left_view_in_gap) return;
    }
    const Eigen::Vector2d tip = far.points.back().p;
    const double pixel_m = view_.pixel_size_m(tip, far.direction);
    if (view_.pixel_size_m(tip, left_of(far.direction)) > 0.7 * width_m_) return;  // the line may only have faded
    const double step_m = std::max(0.25 * pixel_m, 0.002);
    Eigen::Vector2d last = tip;
    for (int i = 1; i < 200; ++i) {
      const Eigen::Vector2d p = tip + i * step_m * far.direction;
      if ((p - last).norm() > std::max(0.06, 5.0 * pixel_m)) break;
      const Seen s = view_.look(p);
      if (s == Seen::kOutside || s == Seen::kStanding || p.norm() > config_.line_max_range_m) return;
      if (s == Seen::kLine) last = p;
    }
    // If the trace missed a bend, the colour of the line is near the tip but off the traced course. That is not an end.
    const double stray_m = 1.5 * width_m_ + 2.0 * pixel_m;
    for (const Eigen::Vector2d& p : pixels_) {
      if ((p - tip).norm() > 0.4) continue;
      const bool traced = std::any_of(trace.points.begin(), trace.points.end(),
                                      [&](const LineTrace::Point& point) { return (p - point.p).norm() < stray_m; });
      if (!traced) return;
    }
    trace.end_visible = true;
    trace.end = last;
  }

  const LineView view_;
  const GroundCamera& camera_;
  const PerceptionConfig& config_;
  double width_m_;  ///< expected at first, then measured
  int width_samples_ = 0;
  std::vector<Eigen::Vector2d> pixels_;  ///< points of the line's colour that no failed attempt has used
};

}  // namespace

LineTrace trace_line(const Labels& labels, const Regions& regions, const GroundCamera& camera,
                     const PerceptionConfig& config, std::uint8_t colour) {
  return Tracer(labels, regions, camera, config, colour).run();
}

}  // namespace constrictor::perception
