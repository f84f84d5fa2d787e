#include "views/camera_views.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "constrictor/constants.hpp"
#include "constrictor/image.hpp"
#include "constrictor/text.hpp"
#include "robot/planar_message.hpp"
#include "views/foxglove_json.hpp"

namespace constrictor::views {
namespace {

using nlohmann::json;

constexpr int kLineLoop = 2, kLineStrip = 3;  // PointsAnnotation.type
const json kLineInk = colour(1.0, 0.9, 0.2);  // not the colour of the line itself, on which it would not be seen
constexpr double kThickness_pixel = 2.0;
constexpr double kText_pixel = 12.0;
constexpr double kNearest_m = 0.01;  // along the optical axis: what is nearer or behind has no place in the image

json pixel(double u, double v) { return {{"x", u}, {"y", v}}; }

json outline(int type, json points, json paint, std::uint64_t time_ns) {
  return {{"timestamp", stamp(time_ns)},     {"type", type},
          {"points", std::move(points)},     {"outline_color", std::move(paint)},
          {"outline_colors", json::array()}, {"fill_color", colour(0, 0, 0, 0)},
          {"thickness", kThickness_pixel}};
}

json label(double u, double v, const std::string& text, json paint, std::uint64_t time_ns) {
  return {{"timestamp", stamp(time_ns)}, {"position", pixel(u, v)},       {"text", text},
          {"font_size", kText_pixel},    {"text_color", colour(1, 1, 1)}, {"background_color", std::move(paint)}};
}

Eigen::Isometry3d isometry(const msg::Pose3& pose) {
  const auto& q = pose.orientation;
  return Eigen::Translation3d(pose.position_m.x, pose.position_m.y, pose.position_m.z) *
         Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

/// The line's points in pixels; empty if the place of the camera is not known.
json line_pixels(const Newest& newest) {
  json points = json::array();
  const auto head = newest.heads.find(newest.line->exposure_tick);
  if (!newest.camera || head == newest.heads.end()) return points;
  const msg::CameraInfo& camera = *newest.camera;
  const PlanarPose ground = planar(head->second);  // frame G: the head, projected on the ground
  const Eigen::Isometry3d X_CW = (isometry(head->second) * isometry(camera.X_HC)).inverse();
  for (std::size_t i = 0; i < newest.line->point_count; ++i) {
    const Eigen::Vector2d p_W = ground.to_parent({newest.line->x_m[i], newest.line->y_m[i]});
    const Eigen::Vector3d p_C = X_CW * Eigen::Vector3d(p_W.x(), p_W.y(), 0.0);
    if (!(p_C.z() > kNearest_m)) continue;
    points.push_back(pixel(camera.fx * p_C.x() / p_C.z() + camera.cx, camera.fy * p_C.y() / p_C.z() + camera.cy));
  }
  return points;
}

std::string describe(const msg::Blob& blob) {
  std::string text =
      fmt::format("{} {}", name_of(constants::kColour, blob.colour), name_of(constants::kBlob, blob.kind));
  if (std::isfinite(blob.range_m)) text += fmt::format(" {:.2f} m", blob.range_m);
  return text;
}

}  // namespace

json camera_calibration(const msg::CameraInfo& info, std::uint64_t time_ns) {
  return {{"timestamp", stamp(time_ns)},
          {"frame_id", kCameraFrame},
          {"width", info.width},
          {"height", info.height},
          {"distortion_model", "plumb_bob"},
          {"D", {0.0, 0.0, 0.0, 0.0, 0.0}},
          {"K", {info.fx, 0.0, info.cx, 0.0, info.fy, info.cy, 0.0, 0.0, 1.0}},
          {"R", {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}},
          {"P", {info.fx, 0.0, info.cx, 0.0, 0.0, info.fy, info.cy, 0.0, 0.0, 0.0, 1.0, 0.0}}};
}

json image_annotations(const Newest& newest, std::uint64_t time_ns) {
  json outlines = json::array();
  json texts = json::array();
  if (newest.line && newest.line->visible) {
    json points = line_pixels(newest);
    if (points.size() > 1) outlines.push_back(outline(kLineStrip, std::move(points), kLineInk, time_ns));
  }
  for (std::size_t i = 0; newest.blobs && i < newest.blobs->blob_count; ++i) {
    const msg::Blob& blob = newest.blobs->blobs[i];
    // The last column and row belong to the box.
    const double left = blob.u_min, right = blob.u_max + 1.0, top = blob.v_min, bottom = blob.v_max + 1.0;
    outlines.push_back(outline(kLineLoop,
                               {pixel(left, top), pixel(right, top), pixel(right, bottom), pixel(left, bottom)},
                               colour_of(blob.colour), time_ns));
    texts.push_back(label(left, top, describe(blob), colour_of(blob.colour), time_ns));
  }
  return {{"circles", json::array()}, {"points", std::move(outlines)}, {"texts", std::move(texts)}};
}

std::optional<std::string> ros_image(const msg::CameraImage& image, const std::string& frame, std::uint64_t time_ns) {
  if (!image_violation(image).empty()) return {};
  std::string cdr{"\0\1\0\0", 4};  // little-endian CDR
  const auto u32 = [&](std::uint32_t value) {
    while ((cdr.size() - 4) % 4 != 0) cdr += '\0';
    for (int i = 0; i < 4; ++i) cdr += static_cast<char>(value >> (8 * i) & 0xffu);
  };
  const auto text = [&](const std::string& words) {
    u32(static_cast<std::uint32_t>(words.size() + 1));
    cdr += words + '\0';
  };
  u32(static_cast<std::uint32_t>(time_ns / 1'000'000'000));
  u32(static_cast<std::uint32_t>(time_ns % 1'000'000'000));
  text(frame);
  u32(image.height);
  u32(image.width);
  text("rgb8");
  cdr += '\0';  // is_bigendian
  u32(3u * image.width);
  u32(image.data._length);
  cdr.append(reinterpret_cast<const char*>(image.data._buffer), image.data._length);
  return cdr;
}

}  // namespace constrictor::views
