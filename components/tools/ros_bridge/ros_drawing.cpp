#include "ros_bridge/ros_drawing.hpp"

#include <algorithm>
#include <cmath>

#include "constrictor/colours.hpp"
#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {
namespace {

// Source: visualization_msgs/msg/Marker.msg.
constexpr std::int32_t kCylinder = 3, kLineStrip = 4, kSphereList = 7, kTextViewFacing = 9;
constexpr std::int32_t kDeleteAll = 3;

// Heights and widths of what is drawn [m]. The robot does not measure the heights of objects.
constexpr double kObjectHeight_m = 0.15, kFlat_m = 0.005, kLineWidth_m = 0.03, kTouch_m = 0.03, kObstacle_m = 0.05,
                 kText_m = 0.08;
// The radius of a landmark whose radius is not known yet [m].
constexpr double kObjectRadius_m = 0.08, kZoneRadius_m = 0.25;

/// A size that a viewer can draw. The IDL has no bound for sizes.
double drawable_m(double size_m) { return std::clamp(size_m, 0.001, 1000.0); }

std_msgs_msg_dds__ColorRGBA_ colour_of(std::uint8_t named, double alpha) {
  const Rgb8& screen = look_of(named).screen;
  const auto part = [&](std::size_t channel) { return static_cast<float>(screen[channel]) / 255.0F; };
  return {part(0), part(1), part(2), static_cast<float>(alpha)};
}

}  // namespace

std::string unfit(const msg::FieldMap& map) { return broken(map); }
std::string unfit(const msg::LinePercept& line) { return broken_exposure(line); }
std::string unfit(const msg::ObjectPercepts& objects) { return broken_exposure(objects); }
std::string unfit(const msg::TaskCommand& command) { return broken(command); }

void Drawing::begin(std::int64_t time_ns, const char* frame) {
  header_ = header_of(time_ns, text(frame));
  markers_.clear();
  texts_.clear();
  points_.clear();
  add("", 0, 0, msg::kColourUnknown, 0).action = kDeleteAll;
}

Marker& Drawing::add(const char* name_space, int id, int type, std::uint8_t colour, double alpha) {
  Marker marker{};
  marker.header = header_;
  marker.ns = text(name_space);
  marker.id = id;
  marker.type = type;
  marker.pose.orientation.w = 1;
  marker.color = colour_of(colour, alpha);
  marker.texture.header.frame_id = text("");
  for (char** unused : {&marker.texture_resource, &marker.texture.format, &marker.text, &marker.mesh_resource,
                        &marker.mesh_file.filename}) {
    *unused = text("");
  }
  return markers_.emplace_back(marker);
}

std::vector<geometry_msgs_msg_dds__Point_>& Drawing::points_of(Marker& marker) {
  marker.scale = {kLineWidth_m, 0, 0};
  return points_.emplace_back();
}

MarkerArray Drawing::markers() {
  // The lists of points are complete now. They belong to the markers with points, in their order.
  auto list = points_.begin();
  for (Marker& marker : markers_) {
    if (marker.action == kDeleteAll || (marker.type != kLineStrip && marker.type != kSphereList)) continue;
    borrow(marker.points, *list++);
  }
  MarkerArray message{};
  borrow(message.markers, markers_);
  return message;
}

MarkerArray Drawing::map(const msg::FieldMap& map) {
  begin(map.header.time_ns, "odom");
  if (map.line_point_count > 0) {
    // The points are in the order of discovery, so that neighbours in the list may lie far apart.
    Marker& line = add("line", 0, kSphereList, map.line_colour, 1);
    auto& points = points_of(line);
    line.scale = {kLineWidth_m, kLineWidth_m, kLineWidth_m};
    for (std::size_t i = 0; i < map.line_point_count; ++i)
      points.push_back({map.line_x_m[i], map.line_y_m[i], kFlat_m});
  }
  for (std::size_t i = 0; i < map.object_count; ++i) {
    const msg::MapObject& object = map.objects[i];
    const bool zone = object.kind == msg::kBlobZone;
    const double unknown_height_m = zone ? kFlat_m : kObjectHeight_m;
    const double height_m = std::isnan(object.height_m) ? unknown_height_m : drawable_m(object.height_m);
    const double unknown_m = zone ? kZoneRadius_m : kObjectRadius_m;
    const double radius_m = std::isnan(object.radius_m) ? unknown_m : drawable_m(object.radius_m);
    // An object whose position no touch has confirmed is drawn paler.
    const double alpha = zone ? 0.4 : object.touched || object.carried ? 1.0 : 0.6;
    Marker& body = add(zone ? "zones" : "objects", object.handle, kCylinder, object.colour, alpha);
    body.pose.position = {object.x_m, object.y_m, 0.5 * height_m};
    body.scale = {2 * radius_m, 2 * radius_m, height_m};
    Marker& number = add("numbers", object.handle, kTextViewFacing, object.colour, 1);
    number.pose.position = {object.x_m, object.y_m, height_m + kText_m};
    number.scale.z = kText_m;
    number.text = text(texts_.emplace_back(std::to_string(object.handle) + (object.carried ? " (carried)" : "")));
  }
  if (map.touch_count > 0) {
    Marker& touches = add("touches", 0, kSphereList, msg::kColourUnknown, 1);
    auto& points = points_of(touches);
    touches.scale = {kTouch_m, kTouch_m, kTouch_m};
    for (std::size_t i = 0; i < map.touch_count; ++i)
      points.push_back({map.touches[i].x_m, map.touches[i].y_m, head_height_m_});
  }
  if (map.obstacle_count > 0) {
    Marker& obstacles = add("obstacles", 0, kSphereList, msg::kColourUnknown, 1);
    auto& points = points_of(obstacles);
    obstacles.scale = {kObstacle_m, kObstacle_m, kObstacle_m};
    for (std::size_t i = 0; i < map.obstacle_count; ++i)
      points.push_back({map.obstacle_x_m[i], map.obstacle_y_m[i], kObstacle_m});
  }
  return markers();
}

MarkerArray Drawing::line_in_view(const msg::LinePercept& line) {
  begin(exposure_ns(line.header, line.exposure_tick), "base_link");
  if (line.visible && line.point_count >= 2) {
    auto& points = points_of(add("line_in_view", 0, kLineStrip, line.colour, 1));
    for (std::size_t i = 0; i < line.point_count; ++i)
      points.push_back({line.x_m[i], line.y_m[i], kFlat_m - head_height_m_});
  }
  return markers();
}

MarkerArray Drawing::objects_in_view(const msg::ObjectPercepts& objects) {
  begin(exposure_ns(objects.header, objects.exposure_tick), "base_link");
  for (std::size_t i = 0; i < objects.blob_count; ++i) {
    const msg::Blob& blob = objects.blobs[i];
    if (std::isnan(blob.range_m)) continue;
    const double width_m = std::isnan(blob.width_m) ? 2 * kObjectRadius_m : drawable_m(blob.width_m);
    const double object_m = std::isnan(blob.height_m) ? kObjectHeight_m : drawable_m(blob.height_m);
    const double height_m = blob.kind == msg::kBlobObject ? object_m : kFlat_m;
    const double centre_m = blob.range_m + 0.5 * width_m;  // the range is that of the nearest point
    Marker& body = add("objects_in_view", static_cast<int>(i), kCylinder, blob.colour,
                       blob.kind == msg::kBlobUndecided ? 0.3 : 0.8);
    body.pose.position = {centre_m * std::cos(blob.bearing_rad), centre_m * std::sin(blob.bearing_rad),
                          0.5 * height_m - head_height_m_};
    body.scale = {width_m, width_m, height_m};
  }
  return markers();
}

Path Drawing::path(std::int64_t time_ns, const double* x_m, const double* y_m, std::size_t count) {
  header_ = header_of(time_ns, text("odom"));
  poses_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i + 1 < count ? i : std::max<std::size_t>(i, 1) - 1;  // the last looks as the one before
    const std::size_t to = std::min(from + 1, count - 1);
    const double yaw_rad = std::atan2(y_m[to] - y_m[from], x_m[to] - x_m[from]);
    poses_.push_back({header_, {{x_m[i], y_m[i], 0}, yaw_rotation(yaw_rad)}});
  }
  Path message{};
  message.header = header_;
  borrow(message.poses, poses_);
  return message;
}

Path Drawing::line(const msg::FieldMap& map) {
  return path(map.header.time_ns, map.line_x_m, map.line_y_m, map.line_point_count);
}

Path Drawing::plan(const msg::TaskCommand& command) {
  const bool follows = command.command == msg::kCommandStart && command.task == msg::kTaskFollowPath;
  return path(command.header.time_ns, command.path.x_m, command.path.y_m, follows ? command.path.point_count : 0);
}

}  // namespace constrictor::ros_bridge
