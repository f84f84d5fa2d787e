#include "perception/percept_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "component/random.hpp"

namespace constrictor::perception {
namespace {

// An invented object has one of these colours, and a range and a radius within these bounds.
constexpr std::array<std::uint8_t, 2> kColours{msg::kColourGreen, msg::kColourRed};
constexpr double kNearest_m = 0.5, kFarthest_m = 2.0;     // range
constexpr double kThinnest_m = 0.05, kThickest_m = 0.12;  // radius
constexpr double kHeight_m = 0.15;
constexpr double kLeastFactor = 0.1;  // of the noise of ranges: none is nearer than this share of the truth
constexpr double kInnerShare = 0.9;   // of the field of view: no object is invented at the border of the image

bool is_zone(const msg::Blob& blob) { return blob.kind == msg::kBlobZone; }

std::string stream_of(const char* error, const msg::Blob& blob) {
  return fmt::format("{} {} {}", error, blob.colour, is_zone(blob) ? "zone" : "object");
}

/// The box in the image around an upright cylinder that stands at `centre` in G; none if less than a pixel of it is in
/// the image.
bool put_into_image(const GroundCamera& camera, const Eigen::Vector2d& centre, double radius_m, msg::Blob& blob) {
  const Eigen::Vector2d across = radius_m * Eigen::Vector2d(-centre.y(), centre.x()).normalized();
  const Eigen::Vector2d near = centre - radius_m * centre.normalized();
  double u_min = 1e9, u_max = -1e9, v_min = 1e9, v_max = -1e9;
  for (const auto& [at, height_m] : {std::pair<Eigen::Vector2d, double>{centre + across, 0.0},
                                     {centre - across, 0.0},
                                     {centre + across, kHeight_m},
                                     {centre - across, kHeight_m},
                                     {near, 0.0}}) {
    const auto pixel = camera.pixel(Eigen::Vector3d(at.x(), at.y(), height_m));
    if (!pixel) return false;
    u_min = std::min(u_min, pixel->x());
    u_max = std::max(u_max, pixel->x());
    v_min = std::min(v_min, pixel->y());
    v_max = std::max(v_max, pixel->y());
  }
  blob.cut_left = u_min < 0.0;
  blob.cut_right = u_max >= camera.width();
  blob.cut_top = v_min < 0.0;
  blob.cut_bottom = v_max >= camera.height();
  const auto column = [&](double u) { return static_cast<std::uint16_t>(std::clamp(u, 0.0, camera.width() - 1.0)); };
  const auto row = [&](double v) { return static_cast<std::uint16_t>(std::clamp(v, 0.0, camera.height() - 1.0)); };
  blob.u_min = column(u_min);
  blob.u_max = column(u_max);
  blob.v_min = row(v_min);
  blob.v_max = row(v_max);
  if (blob.u_max <= blob.u_min || blob.v_max <= blob.v_min) return false;
  blob.area_fraction =
      static_cast<double>((blob.u_max - blob.u_min) * (blob.v_max - blob.v_min)) / (camera.width() * camera.height());
  return true;
}

}  // namespace

bool PerceptErrorConfig::any() const {
  return missed_share > 0.0 || missed_line_share > 0.0 || false_share > 0.0 || range_factor != 1.0 ||
         range_noise > 0.0 || line_noise_m > 0.0;
}

void PerceptErrors::apply(double exposure_s, double yaw_rad, const GroundCamera& camera, msg::LinePercept& line,
                          msg::ObjectPercepts& objects) const {
  // The margin keeps exposures at the beginning of an interval in it.
  const auto interval = static_cast<std::uint64_t>(std::max(0.0, std::floor(exposure_s / config_.lasts_s + 1e-6)));
  miss(interval, line, objects);
  shift(interval, line, objects);
  invent(interval, yaw_rad, camera, objects);
}

void PerceptErrors::miss(std::uint64_t interval, msg::LinePercept& line, msg::ObjectPercepts& objects) const {
  const auto missed = [&](const msg::Blob& blob) {
    return Random(seed_ + interval, stream_of("missed", blob)).uniform() < config_.missed_share;
  };
  msg::Blob* const end = std::remove_if(objects.blobs, objects.blobs + objects.blob_count, missed);
  std::fill(end, objects.blobs + objects.blob_count, msg::Blob{});
  objects.blob_count = static_cast<std::uint16_t>(end - objects.blobs);
  if (!line.visible || Random(seed_ + interval, "missed line").uniform() >= config_.missed_line_share) return;
  const msg::LinePercept seen = line;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  line = {};
  line.exposure_tick = seen.exposure_tick;
  line.colour = seen.colour;
  line.lookahead_m = seen.lookahead_m;
  line.end_distance_m = line.offset_m = line.heading_rad = line.curvature_1_m = line.near_m = line.far_m = kNan;
}

void PerceptErrors::shift(std::uint64_t interval, msg::LinePercept& line, msg::ObjectPercepts& objects) const {
  for (msg::Blob* blob = objects.blobs; blob != objects.blobs + objects.blob_count; ++blob) {
    Random random(seed_ + interval, stream_of("range", *blob));
    blob->range_m *= config_.range_factor * std::max(kLeastFactor, 1.0 + config_.range_noise * random.normal());
    blob->width_m *= config_.range_factor;
    blob->height_m *= config_.range_factor;
  }
  const double factor = config_.range_factor;
  for (int i = 0; i < objects.obstacle_count; ++i) {
    objects.obstacle_x_m[i] *= factor;
    objects.obstacle_y_m[i] *= factor;
  }
  for (double* length : {&line.lookahead_m, &line.offset_m, &line.near_m, &line.far_m, &line.end_distance_m})
    *length *= factor;
  line.curvature_1_m /= factor;
  const double shift_m = config_.line_noise_m * Random(seed_ + interval, "line").normal();
  line.offset_m += shift_m;
  for (int i = 0; i < line.point_count; ++i) {
    line.x_m[i] *= factor;
    line.y_m[i] = factor * line.y_m[i] + shift_m;
  }
}

void PerceptErrors::invent(std::uint64_t interval, double yaw_rad, const GroundCamera& camera,
                           msg::ObjectPercepts& objects) const {
  Random random(seed_ + interval, "invented");
  if (random.uniform() >= config_.false_share || objects.blob_count >= std::size(objects.blobs)) return;
  msg::Blob blob{};
  blob.kind = msg::kBlobObject;
  blob.object_probability = 1.0;
  blob.colour = kColours[random.next() % kColours.size()];
  const double direction_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  blob.range_m = random.uniform(kNearest_m, kFarthest_m);
  const double radius_m = random.uniform(kThinnest_m, kThickest_m);
  blob.width_m = 2.0 * radius_m;
  blob.height_m = kHeight_m;
  // The direction wraps around at the sides of the field of view, so that the object is always in view: an object that
  // leaves the view at one side enters it at the other side.
  const double half_view_rad = kInnerShare * std::atan(0.5 * camera.width() / camera.focal_pixels());
  const double turn = (direction_rad - yaw_rad) / (2.0 * half_view_rad);
  blob.bearing_rad = (2.0 * (turn - std::floor(turn)) - 1.0) * half_view_rad;
  const Eigen::Vector2d centre =
      (blob.range_m + radius_m) * Eigen::Vector2d(std::cos(blob.bearing_rad), std::sin(blob.bearing_rad));
  if (!put_into_image(camera, centre, radius_m, blob)) return;
  msg::Blob* const end = objects.blobs + objects.blob_count;
  msg::Blob* const place = std::find_if(
      objects.blobs, end, [&](const msg::Blob& other) { return other.area_fraction < blob.area_fraction; });
  std::move_backward(place, end, end + 1);
  *place = blob;
  ++objects.blob_count;
}

}  // namespace constrictor::perception
