#include "perception/gauge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "configuration/quantiles.hpp"
#include "perception/colour_edge.hpp"
#include "perception/silhouette.hpp"

namespace constrictor::perception {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMeasuredRange_m = 1.5;  // objects that are nearer show their size
constexpr double kBeside_sd = -2.0;  // of the flat part beside an upright one, which the same region shows to be lower

/// Probability that a normally distributed quantity, measured this number of standard deviations above a bound, is
/// above it.
double probability_above(double deviations) { return 0.5 * std::erfc(-deviations / std::numbers::sqrt2); }

}  // namespace

Gauge::Gauge(const cv::Mat& rgb, const Regions& regions, std::size_t index, const GroundCamera& camera,
             const PerceptionConfig& config, const ObjectSizes& sizes)
    : rgb_(rgb),
      regions_(regions),
      region_(regions.regions[index]),
      id_(static_cast<std::uint8_t>(index + 1)),
      camera_(camera),
      config_(config),
      sizes_(sizes.of[regions.regions[index].colour]) {
  if (region_.low) {
    left_ = region_.left_rad;
    right_ = region_.right_rad;
    left_hidden_ = region_.left_hidden;
    right_hidden_ = region_.right_hidden;
  } else if (region_.standing()) {
    find_sides();
  }
}

std::optional<msg::Blob> Gauge::object(bool on_zone, ObjectSize& measured) const {
  msg::Blob blob = box(region_.standing_first, region_.standing_last);
  if (left_ <= right_) return std::nullopt;
  blob.kind = msg::kBlobObject;
  blob.object_probability = probability_above(std::max(region_.rise_sd, 0.0));
  bool cut = false;
  double range_m = on_zone ? kNan : lower_edge_range(left_, right_, cut);
  blob.cut_bottom |= cut;
  blob.cut_left |= left_hidden_;
  blob.cut_right |= right_hidden_;
  const bool whole = std::isfinite(range_m) && !on_zone && !blob.cut_left && !blob.cut_right;
  if (!std::isfinite(range_m)) {
    // If something hides the foot of the object, the range follows from its height: a guessed height would give a
    // guessed range.
    const bool foot_hidden = !on_zone && !blob.cut_bottom;
    if (!foot_hidden || sizes_.known() || config_.height_stated) range_m = range_by_size(blob, on_zone);
  } else if (whole && ends_in_zone(range_m)) {
    range_m = range_by_width(likeliest_size(blob, upper_slope(), false));
  }
  auto result = finish(blob, left_, right_, range_m);
  if (!result) return result;
  result->height_m = height_m(range_m, blob.cut_top);
  if (whole && !blob.cut_top && range_m < kMeasuredRange_m && std::isfinite(result->height_m))
    measured = {0.5 * result->width_m, result->height_m, 1};
  return result;
}

std::optional<msg::Blob> Gauge::zone() const {
  double right = 1e9, left = -1e9, lateral_min = 1e9, lateral_max = -1e9;
  bool left_hidden = false, right_hidden = false;
  for (int v = region_.v_min; v <= region_.v_max; ++v) {
    int first = -1, last = -1;
    for (int u = region_.u_min; u <= region_.u_max; ++u) {
      if (regions_.ids.at<std::uint8_t>(v, u) != id_ || in_object(u, v)) continue;
      if (first < 0) first = u;
      last = u;
    }
    if (first < 0 || v < camera_.horizon_row(0.5 * (first + last))) continue;
    const double row_left = azimuth({first, v + 0.5}), row_right = azimuth({last + 1.0, v + 0.5});
    if (row_left > left) left_hidden = hidden_beyond(first - 1, v);
    if (row_right < right) right_hidden = hidden_beyond(last + 2, v);
    left = std::max(left, row_left);
    right = std::min(right, row_right);
    for (const int u : {first, last + 1}) {
      if (const auto p = camera_.ground(u, v + 0.5)) {
        lateral_min = std::min(lateral_min, p->y());
        lateral_max = std::max(lateral_max, p->y());
      }
    }
  }
  if (left <= right) return std::nullopt;
  msg::Blob blob = box(region_.u_min, region_.u_max);
  if (region_.standing()) blob.cut_top = false;  // only the object beside it reaches up there
  blob.kind = region_.doubtful || may_be_object(blob, left, right) ? msg::kBlobUndecided : msg::kBlobZone;
  blob.object_probability = blob.kind == msg::kBlobUndecided ? 0.5
                            : region_.standing()             ? probability_above(kBeside_sd)
                                                             : probability_above(std::min(region_.rise_sd, 0.0));
  bool cut = false;
  const double range_m = is_behind_object(left, right) ? kNan : lower_edge_range(left, right, cut);
  blob.cut_bottom |= cut;
  blob.cut_left |= left_hidden;
  blob.cut_right |= right_hidden;
  auto result = finish(blob, left, right, range_m);
  if (result && result->kind == msg::kBlobZone && !std::isfinite(result->width_m) && lateral_max > lateral_min) {
    result->width_m = lateral_max - lateral_min;
  }
  return result;
}

void Gauge::flat_part(int& pixels, bool& nearer) const {
  pixels = 0;
  int lowest = 0, object_lowest = 0;
  const int middle = (region_.standing_first + region_.standing_last) / 2;
  for (int v = region_.v_min; v <= region_.v_max; ++v) {
    for (int u = region_.u_min; u <= region_.u_max; ++u) {
      if (regions_.ids.at<std::uint8_t>(v, u) != id_) continue;
      if (!in_object(u, v)) {
        ++pixels;
        lowest = v;
      } else if (u == middle) {
        object_lowest = v;
      }
    }
  }
  nearer = lowest >= object_lowest - 2 || (left_open_ != right_open_ && edge_goes_on());
}

bool Gauge::edge_goes_on() const {
  constexpr int kAside = 3, kStep = 4;  // pixels
  int object_lowest = 0, flat_lowest = 0;
  for (int v = region_.v_min; v <= region_.v_max; ++v) {
    bool object_right = in_object(region_.u_min + kAside, v);
    for (int u = region_.u_min + kAside; u + kAside < region_.u_max; ++u) {
      const bool object_left = std::exchange(object_right, in_object(u + 1, v));
      if (object_left == object_right) continue;
      const int left = u - kAside, right = u + 1 + kAside;
      if (regions_.ids.at<std::uint8_t>(v, object_right ? right : left) == id_) object_lowest = v;
      if (regions_.ids.at<std::uint8_t>(v, object_right ? left : right) == id_) flat_lowest = v;
    }
  }
  return flat_lowest > 0 && flat_lowest >= object_lowest - kStep;
}

bool Gauge::in_object(int u, int v) const {
  if (!region_.standing()) return false;
  const double margin = 2.5 / camera_.width();
  const double a = azimuth({u + 0.5, v + 0.5});
  return (right_open_ || a > right_ - margin) && (left_open_ || a < left_ + margin);
}

bool Gauge::hidden_beyond(int u, int v) const {
  constexpr int kFadingPixels = 5;  // between a colour and the place where glare hides it
  for (int aside = -kFadingPixels; aside <= kFadingPixels; ++aside) {
    if (regions_.dazzled_at(u + aside, v)) return true;
  }
  return camera_.sees_body() && camera_.own_body(u, v + 0.5);
}

bool Gauge::may_be_object(const msg::Blob& blob, double left, double right) const {
  if (blob.cut_top) return true;
  if (blob.cut_left == blob.cut_right) return false;
  const auto side = vertical_plane(camera_, blob.cut_left ? right : left);
  if (!side) return true;
  return blob.cut_left ? side->horizon.x() < 3.0 : side->horizon.x() > camera_.width() - 3.0;
}

msg::Blob Gauge::box(int u_min, int u_max) const {
  msg::Blob blob{};
  blob.colour = region_.colour;
  blob.u_min = static_cast<std::uint16_t>(u_min);
  blob.u_max = static_cast<std::uint16_t>(u_max);
  blob.v_min = static_cast<std::uint16_t>(region_.v_min);
  blob.v_max = static_cast<std::uint16_t>(region_.v_max);
  int pixels = 0;
  for (int v = region_.v_min; v <= region_.v_max; ++v) {
    for (int u = u_min; u <= u_max; ++u) pixels += regions_.ids.at<std::uint8_t>(v, u) == id_ ? 1 : 0;
  }
  blob.area_fraction = static_cast<double>(pixels) / (camera_.width() * camera_.height());
  blob.cut_left = u_min == 0;
  blob.cut_right = u_max == camera_.width() - 1;
  blob.cut_top = region_.v_min == 0;
  blob.cut_bottom = region_.v_max == camera_.height() - 1;
  return blob;
}

void Gauge::find_sides() {
  Few<double, 6> lefts, rights;  // of the rows around the horizon
  std::size_t lefts_hidden = 0, rights_hidden = 0;
  const double middle = 0.5 * (region_.standing_first + region_.standing_last + 1);
  const int horizon = static_cast<int>(std::floor(camera_.horizon_row(middle)));
  for (int v = horizon - 3; v <= horizon + 2; ++v) {
    const int row = std::clamp(v, region_.v_min, region_.v_max);
    const Eigen::Vector2d start(middle, row + 0.5);
    const Edge l = find_edge(rgb_, regions_, camera_, id_, start, {-1.0, 0.0}, kMaxGapPixels);
    const Edge r = find_edge(rgb_, regions_, camera_, id_, start, {1.0, 0.0}, kMaxGapPixels);
    if (l.state != EdgeState::kNone) lefts.push_back(azimuth(l.pixel));
    if (r.state != EdgeState::kNone) rights.push_back(azimuth(r.pixel));
    lefts_hidden += l.state == EdgeState::kCut ? 1 : 0;
    rights_hidden += r.state == EdgeState::kCut ? 1 : 0;
  }
  left_hidden_ = camera_.sees_body() && 2 * lefts_hidden > lefts.size();
  right_hidden_ = camera_.sees_body() && 2 * rights_hidden > rights.size();
  if (lefts.empty() || rights.empty()) return;
  left_ = upper_median(lefts);
  right_ = upper_median(rights);
  // The object continues beyond the border of the image.
  left_open_ = region_.standing_first == 0;
  right_open_ = region_.standing_last == camera_.width() - 1;
}

double Gauge::lower_edge_range(double left, double right, bool& cut) const {
  const double max_gap = region_.standing() && !region_.low ? kMaxGapPixels : 1e9;
  return lower_edge_range_m(rgb_, camera_, regions_, id_, right, left, max_gap, cut);
}

bool Gauge::is_behind_object(double left, double right) const {
  constexpr double kFarther = 1.1, kFarther_m = 0.02;
  const double pixel_rad = 1.0 / camera_.width();
  if (!region_.standing() || left_ <= right_) return false;
  bool cut = false;
  double beside_m = std::numeric_limits<double>::infinity();
  const auto look = [&](double from, double to) {
    if (to - from < 2.0 * pixel_rad) return;
    const double range_m = lower_edge_range_m(rgb_, camera_, regions_, id_, from, to, 1e9, cut);
    if (std::isfinite(range_m)) beside_m = std::min(beside_m, range_m);
  };
  const double gap = 3.0 * pixel_rad, width = 12.0 * pixel_rad;
  look(left_ + gap, std::min(left_ + width, left));
  look(std::max(right_ - width, right), right_ - gap);
  if (!std::isfinite(beside_m)) return false;
  return beside_m > kFarther * lower_edge_range(left_, right_, cut) + kFarther_m;  // false for NaN
}

double Gauge::height_m(double range_m, bool cut_top) const {
  if (region_.low) return region_.height_m;
  Few<double, kPaths> slopes;
  if (cut_top) slopes.push_back(-descent(camera_, {0.5 * (region_.standing_first + region_.standing_last + 1), 0.0}));
  else slopes = upper_edge_slopes(rgb_, camera_, regions_, id_, right_, left_);
  return slopes.empty() ? kNan : camera_.height_m() + range_m * upper_median(slopes);
}

std::optional<msg::Blob> Gauge::finish(msg::Blob blob, double left, double right, double range_m) const {
  const double middle = 0.5 * (left + right);
  blob.bearing_rad = middle;
  blob.range_m = kNan;
  blob.width_m = kNan;
  blob.height_m = kNan;
  if (!std::isfinite(range_m)) return blob;
  if (range_m > config_.blob_max_range_m) return std::nullopt;
  const auto [centre_m, radius_m] = Disc::between_tangents(range_m, left - right);
  const Eigen::Vector2d centre =
      camera_.position_on_ground() + centre_m * Eigen::Vector2d(std::cos(middle), std::sin(middle));
  blob.bearing_rad = std::atan2(centre.y(), centre.x());
  blob.range_m = std::max(centre.norm() - radius_m, 0.0);
  blob.width_m = 2.0 * radius_m;
  return blob;
}

}  // namespace constrictor::perception
