// Markers and paths for RViz, against the map and the percepts from which they are drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "ros_bridge/ros_drawing.hpp"

namespace constrictor::ros_bridge {
namespace {

constexpr double kHead_m = 0.035;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Source: visualization_msgs/msg/Marker.msg.
constexpr int kCylinder = 3, kLineStrip = 4, kSphereList = 7, kText = 9, kAdd = 0, kDeleteAll = 3;

/// The markers of a message by namespace and id. The first marker must delete the old ones.
std::map<std::string, Marker> by_name(const MarkerArray& message) {
  EXPECT_GE(message.markers._length, 1u);
  EXPECT_EQ(message.markers._buffer[0].action, kDeleteAll);
  std::map<std::string, Marker> markers;
  for (std::uint32_t i = 1; i < message.markers._length; ++i) {
    const Marker& marker = message.markers._buffer[i];
    EXPECT_EQ(marker.action, kAdd);
    EXPECT_EQ(marker.pose.orientation.w, 1);
    EXPECT_TRUE(marker.text && marker.mesh_resource && marker.texture_resource && marker.mesh_file.filename &&
                marker.texture.format && marker.texture.header.frame_id)
        << "DDS cannot write a string that is null";
    const bool added = markers.emplace(std::string(marker.ns) + " " + std::to_string(marker.id), marker).second;
    EXPECT_TRUE(added) << marker.ns << " " << marker.id << " twice";
  }
  return markers;
}

msg::FieldMap field() {
  msg::FieldMap map{};
  map.header.time_ns = 7'100'000'000;
  map.line_colour = msg::kColourBlue;
  map.line_point_count = 3;
  for (int i = 0; i < 3; ++i) {
    map.line_x_m[i] = i;
    map.line_y_m[i] = i < 2 ? 0.0 : 1.0;
  }
  map.object_count = 2;
  map.objects[0] = {7, msg::kColourRed, msg::kBlobObject, 1.5, 0.5, 0.09, 0.25, 0.02, true, false, 40, 1.0};
  map.objects[1] = {9, msg::kColourGreen, msg::kBlobZone, -1.0, 2.0, kNaN, kNaN, 0.1, false, false, 50, 0.0};
  map.touch_count = 1;
  map.touches[0] = {1.4, 0.4, 2.0, 3, 300, 0};
  map.obstacle_count = 2;
  map.obstacle_x_m[1] = 0.8;
  map.obstacle_y_m[1] = -0.6;
  return map;
}

TEST(RosDrawing, TheMapShowsLineLandmarksAndTouchesWhereTheyAre) {
  Drawing drawing(kHead_m);
  const auto markers = by_name(drawing.map(field()));
  ASSERT_EQ(markers.size(), 7u);
  const Marker& line = markers.at("line 0");
  EXPECT_STREQ(line.header.frame_id, "odom");
  EXPECT_EQ(line.header.stamp.sec, 7);
  EXPECT_EQ(line.header.stamp.nanosec, 100'000'000u);
  EXPECT_EQ(line.type, kSphereList);
  EXPECT_GT(line.scale.x, 0);
  ASSERT_EQ(line.points._length, 3u);
  EXPECT_EQ(line.points._buffer[2].x, 2);
  EXPECT_EQ(line.points._buffer[2].y, 1);
  EXPECT_GT(line.color.b, line.color.r);
  const Marker& object = markers.at("objects 7");
  EXPECT_EQ(object.type, kCylinder);
  EXPECT_EQ(object.pose.position.x, 1.5);
  EXPECT_EQ(object.pose.position.y, 0.5);
  EXPECT_EQ(object.pose.position.z, object.scale.z / 2) << "it must stand on the ground";
  EXPECT_EQ(object.scale.x, 0.18);
  EXPECT_EQ(object.scale.z, 0.25);
  EXPECT_EQ(object.color.a, 1) << "it was touched";
  EXPECT_GT(object.color.r, object.color.g);
  const Marker& zone = markers.at("zones 9");
  EXPECT_GT(zone.scale.x, 0) << "an unknown radius must not make it invisible";
  EXPECT_LT(zone.scale.z, 0.02);
  EXPECT_EQ(markers.at("numbers 7").type, kText);
  EXPECT_STREQ(markers.at("numbers 7").text, "7");
  const Marker& touches = markers.at("touches 0");
  EXPECT_EQ(touches.type, kSphereList);
  ASSERT_EQ(touches.points._length, 1u);
  EXPECT_EQ(touches.points._buffer[0].x, 1.4);
  const Marker& obstacles = markers.at("obstacles 0");
  EXPECT_EQ(obstacles.type, kSphereList);
  ASSERT_EQ(obstacles.points._length, 2u);
  EXPECT_EQ(obstacles.points._buffer[1].x, 0.8);
  EXPECT_EQ(obstacles.points._buffer[1].y, -0.6);
}

TEST(RosDrawing, AnEmptyMapDeletesWhatWasDrawn) {
  Drawing drawing(kHead_m);
  static_cast<void>(drawing.map(field()));
  msg::FieldMap empty{};
  EXPECT_TRUE(by_name(drawing.map(empty)).empty());
  EXPECT_EQ(drawing.line(empty).poses._length, 0u);
}

TEST(RosDrawing, PerceptsAreOnTheGroundBelowTheHeadAtTheTimeOfTheExposure) {
  Drawing drawing(kHead_m);
  msg::LinePercept line{};
  line.header.tick = 52;
  line.header.time_ns = 52 * 20'000'000LL;
  line.exposure_tick = 50;
  line.visible = true;
  line.point_count = 2;
  line.x_m[0] = 0.3;
  line.x_m[1] = 0.9;
  line.y_m[1] = 0.1;
  auto markers = by_name(drawing.line_in_view(line));
  const Marker& strip = markers.at("line_in_view 0");
  EXPECT_STREQ(strip.header.frame_id, "base_link");
  EXPECT_EQ(strip.header.stamp.sec, 1);
  EXPECT_EQ(strip.header.stamp.nanosec, 0u);
  EXPECT_NEAR(strip.points._buffer[1].z + kHead_m, 0, 0.01);
  EXPECT_EQ(strip.points._buffer[1].y, 0.1);
  line.visible = false;
  EXPECT_TRUE(by_name(drawing.line_in_view(line)).empty());

  msg::ObjectPercepts objects{};
  objects.blob_count = 2;
  objects.blobs[0].kind = msg::kBlobObject;
  objects.blobs[0].bearing_rad = std::numbers::pi / 2;
  objects.blobs[0].range_m = 1.0;
  objects.blobs[0].width_m = 0.2;
  objects.blobs[0].height_m = 0.3;
  objects.blobs[1].range_m = kNaN;
  markers = by_name(drawing.objects_in_view(objects));
  ASSERT_EQ(markers.size(), 1u) << "a blob of unknown range has no place";
  const Marker& blob = markers.at("objects_in_view 0");
  EXPECT_NEAR(blob.pose.position.x, 0, 1e-12);
  EXPECT_NEAR(blob.pose.position.y, 1.1, 1e-12) << "the range is that of the nearest point, not of the centre";
  EXPECT_EQ(blob.scale.x, 0.2);
  EXPECT_EQ(blob.scale.z, 0.3);
  EXPECT_NEAR(blob.pose.position.z + kHead_m, blob.scale.z / 2, 1e-12);
}

TEST(RosDrawing, PathsLookAlongTheirDirection) {
  Drawing drawing(kHead_m);
  const Path line = drawing.line(field());
  EXPECT_STREQ(line.header.frame_id, "odom");
  ASSERT_EQ(line.poses._length, 3u);
  const auto yaw = [&](int i) {
    const auto& q = line.poses._buffer[i].pose.orientation;
    return 2 * std::atan2(q.z, q.w);
  };
  EXPECT_NEAR(yaw(0), 0, 1e-12);
  EXPECT_NEAR(yaw(1), std::numbers::pi / 4, 1e-12);
  EXPECT_NEAR(yaw(2), std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(line.poses._buffer[2].pose.position.y, 1);

  msg::TaskCommand command{};
  command.task = msg::kTaskFollowPath;
  command.path.point_count = 2;
  command.path.x_m[1] = -1;
  EXPECT_EQ(drawing.plan(command).poses._length, 2u);
  command.command = msg::kCommandCancel;
  EXPECT_EQ(drawing.plan(command).poses._length, 0u);
  command.command = msg::kCommandStart;
  command.task = msg::kTaskFollowLine;
  EXPECT_EQ(drawing.plan(command).poses._length, 0u) << "another task ends the path";
}

TEST(RosDrawing, RefusesWhatRosCannotRepresent) {
  msg::FieldMap map = field();
  EXPECT_EQ(unfit(map), "");
  map.header.time_ns = -1;
  EXPECT_NE(unfit(map), "");
  map = field();
  map.objects[0].x_m = std::numeric_limits<double>::infinity();
  EXPECT_NE(unfit(map), "");
  msg::ObjectPercepts objects{};
  objects.exposure_tick = 5;
  EXPECT_NE(unfit(objects), "") << "an exposure after the message";
}

}  // namespace
}  // namespace constrictor::ros_bridge
