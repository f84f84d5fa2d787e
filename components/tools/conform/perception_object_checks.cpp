// Objects and zones: colour, kind, bearing, range, width, order, bounding box.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration/counted.hpp"

#include "conform/perception_conformance.hpp"

namespace constrictor::conform {
namespace {

SyntheticScene scene_with(const std::vector<Standing>& standing) {
  SyntheticScene scene;
  scene.standing = standing;
  return scene;
}

Standing at(std::uint8_t colour, double distance_m, double bearing_rad) {
  return {colour, distance_m * std::cos(bearing_rad), distance_m * std::sin(bearing_rad), 0.08, 0.15};
}

double distance_m(const Standing& body) { return std::hypot(body.x_m, body.y_m); }

}  // namespace

const msg::Blob* PerceptionConformance::blob(const msg::ObjectPercepts* percepts, std::uint8_t colour,
                                             std::uint8_t kind) {
  if (percepts == nullptr) return nullptr;
  for (int i = 0; i < percepts->blob_count; ++i) {
    const msg::Blob& one = percepts->blobs[i];
    if (one.colour == colour && one.kind == kind) return &one;
  }
  return nullptr;
}

void PerceptionConformance::check_objects() {
  const msg::ObjectPercepts* percepts = objects_of(scene_with({at(msg::kColourGreen, 0.9, 0.0)}));
  const int count = percepts ? percepts->blob_count : 0;
  report_.judge("object", count != 1, fmt::format("{} objects or zones, for one object", count),
                "find connected regions of each colour that are not the line");
  std::string colour;
  for (const std::uint8_t paint : {msg::kColourGreen, msg::kColourRed, msg::kColourYellow}) {
    percepts = objects_of(scene_with({at(paint, 0.9, 0.1)}));
    const std::uint8_t found = percepts && percepts->blob_count > 0 ? percepts->blobs[0].colour : msg::kColourUnknown;
    if (found != paint) colour = fmt::format("colour {} for an object of colour {}", found, paint);
  }
  report_.pass_unless("object_colour", colour, "green, red, yellow",
                      "images are RGB, red first; the numbers of the colours are in common.idl");
  std::string kind;
  percepts = objects_of(scene_with({at(msg::kColourGreen, 0.9, 0.0)}));
  std::string probability;
  const auto judge = [&](const msg::Blob* seen, bool object) {
    if (seen == nullptr) return;
    const double p = seen->object_probability;
    const bool fits = p >= 0.0 && p <= 1.0 && (object ? p >= 0.5 : p <= 0.5);
    if (!fits) probability = fmt::format("{:.2f} for {}", p, object ? "an object" : "a zone");
  };
  const msg::Blob* object = blob(percepts, msg::kColourGreen, msg::kBlobObject);
  if (object == nullptr) kind = "an object is not kBlobObject";
  judge(object, true);
  percepts = objects_of(scene_with({{msg::kColourRed, 1.1, 0.1, 0.3, 0.0}}));
  const msg::Blob* zone = blob(percepts, msg::kColourRed, msg::kBlobZone);
  if (zone == nullptr) kind = "a zone is not kBlobZone";
  judge(zone, false);
  report_.pass_unless("object_kind", kind, "an object, a zone",
                      "what reaches above the horizon, or is too narrow for its depth, stands up");
  report_.pass_unless("object_probability", probability, "agrees with the kind",
                      "0.5 or more for kBlobObject, 0.5 or less for kBlobZone; 1 and 0 if you know no better");
}

void PerceptionConformance::check_bearing() {
  std::string sign, bearing;
  double largest_rad = 0.0;
  for (const double wanted_rad : {0.4, -0.4, 0.0}) {
    const auto* percepts = objects_of(scene_with({at(msg::kColourGreen, 0.9, wanted_rad)}));
    const msg::Blob* seen = blob(percepts, msg::kColourGreen, msg::kBlobObject);
    if (seen == nullptr) {
      bearing = fmt::format("no object is seen at {:.2f} rad", wanted_rad);
      continue;
    }
    const std::string found = fmt::format("{:.2f} rad, for an object at {:.2f} rad", seen->bearing_rad, wanted_rad);
    const double error_rad = std::abs(seen->bearing_rad - wanted_rad);
    largest_rad = std::max(largest_rad, error_rad);
    if (wanted_rad != 0.0 && std::abs(seen->bearing_rad + wanted_rad) < profile_.bearing_rad) sign = found;
    else if (!(error_rad < profile_.bearing_rad)) bearing = found;
  }
  report_.pass_unless("bearing_sign", sign, "positive is left", "positive bearings are on the left of x of G");
  report_.pass_unless("bearing", bearing, fmt::format("{:.3f} rad wrong at most", largest_rad),
                      "the angle at the head's centre, not at the camera, in radians");
}

void PerceptionConformance::check_size() {
  std::string range, width, height;
  double worst_range = 0.0, worst_width = 0.0, worst_height = 0.0;
  const auto judge = [&](const Standing& body, std::uint8_t kind, const char* what) {
    const msg::Blob* seen = blob(objects_of(scene_with({body})), body.colour, kind);
    if (seen == nullptr) {
      range = fmt::format("no {} is seen at {:.2f} m", what, distance_m(body));
      return;
    }
    const double wanted_m = distance_m(body) - body.radius_m;
    const double range_error = std::abs(seen->range_m / wanted_m - 1.0);
    const double width_error = std::abs(seen->width_m / (2.0 * body.radius_m) - 1.0);
    worst_range = std::max(worst_range, range_error);
    worst_width = std::max(worst_width, width_error);
    if (!(range_error < profile_.range_share) && range.empty())
      range = fmt::format("{:.2f} m, for the {} at {:.2f} m", seen->range_m, what, wanted_m);
    if (!(width_error < profile_.width_share) && width.empty())
      width = fmt::format("{:.2f} m, for the {} of {:.2f} m", seen->width_m, what, 2.0 * body.radius_m);
    if (kind != msg::kBlobObject) return;
    const double height_error = std::abs(seen->height_m / body.height_m - 1.0);
    worst_height = std::max(worst_height, height_error);
    if (!(height_error < profile_.height_share) && height.empty())
      height = fmt::format("{:.2f} m, for the {} of {:.2f} m", seen->height_m, what, body.height_m);
  };
  judge(at(msg::kColourGreen, 0.6, 0.1), msg::kBlobObject, "object");
  judge(at(msg::kColourGreen, 1.2, -0.2), msg::kBlobObject, "object");
  judge({msg::kColourRed, 1.1, 0.1, 0.3, 0.0}, msg::kBlobZone, "zone");
  report_.pass_unless("range", range, fmt::format("{:.0f} % wrong at most", 100 * worst_range),
                      "project the lower edge onto the ground; measure from the head's centre, in metres");
  report_.pass_unless("width", width, fmt::format("{:.0f} % wrong at most", 100 * worst_width),
                      "the width at that range, in metres");
  report_.pass_unless("height", height, fmt::format("{:.0f} % wrong at most", 100 * worst_height),
                      "from the range and the upper edge, above the ground, in metres");
}

void PerceptionConformance::check_image_border() {
  const Standing near = at(msg::kColourRed, 0.6, -0.3), far = at(msg::kColourGreen, 1.3, 0.3);
  const msg::ObjectPercepts* percepts = objects_of(scene_with({far, near}));
  const int count = percepts ? percepts->blob_count : 0;
  bool sorted = true;
  for (int i = 1; i < count; ++i)
    sorted = sorted && percepts->blobs[i - 1].area_fraction >= percepts->blobs[i].area_fraction;
  report_.judge("largest_first", count != 2 || !sorted || percepts->blobs[0].colour != msg::kColourRed,
                count != 2 ? counted(count, "object") + ", for two"
                           : fmt::format("{} and {} of the image", percepts->blobs[0].area_fraction,
                                         percepts->blobs[1].area_fraction),
                "sort the blobs by area_fraction, the largest first");
  std::string box;
  for (const Standing& body : {near, far}) {
    const msg::Blob* seen = blob(percepts, body.colour, msg::kBlobObject);
    const Eigen::Vector2d middle = hand_.camera().pixel({body.x_m, body.y_m, 0.5 * body.height_m});
    if (seen == nullptr ||
        (middle.x() > seen->u_min && middle.x() < seen->u_max && middle.y() > seen->v_min && middle.y() < seen->v_max))
      continue;
    box = fmt::format("columns {} to {}, rows {} to {}, for an object at ({:.0f}, {:.0f})", seen->u_min, seen->u_max,
                      seen->v_min, seen->v_max, middle.x(), middle.y());
  }
  report_.pass_unless("box", box, "contains the object",
                      "columns u from the left, rows v from the top, in pixels of the image");
  // The border of a camera with a wide view cuts an object at 0.8 rad.
  const msg::CameraInfo model = hand_.camera().info();
  const double edge_rad = std::atan(0.5 * model.width / model.fx);
  percepts = objects_of(scene_with({at(msg::kColourGreen, 0.7, edge_rad - 0.02)}));
  if (percepts == nullptr || percepts->blob_count == 0)
    return report_.skip("cut", "perception reports no object that the border cuts");
  const msg::Blob& seen = percepts->blobs[0];
  report_.judge("cut", !seen.cut_left || seen.cut_right,
                fmt::format("left {}, right {}, for an object at the left border", seen.cut_left, seen.cut_right),
                "set the flag of the border that the region touches");
}

}  // namespace constrictor::conform
