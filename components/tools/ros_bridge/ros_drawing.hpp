// The map of guidance and the percepts as markers and paths for RViz. Pure: no DDS calls, no clock.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "ros_types.h"

namespace constrictor::ros_bridge {

using Marker = visualization_msgs_msg_dds__Marker_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using Path = nav_msgs_msg_dds__Path_;

/// Why ROS 2 cannot represent a message, as in ros_translator.hpp.
[[nodiscard]] std::string unfit(const msg::FieldMap& map);
[[nodiscard]] std::string unfit(const msg::LinePercept& line);
[[nodiscard]] std::string unfit(const msg::ObjectPercepts& objects);
[[nodiscard]] std::string unfit(const msg::TaskCommand& command);

/// Draws messages for which unfit() is empty. Each array of markers is complete: it begins by deleting all markers of
/// its topic, so that a viewer that starts late, or loses a message, shows the same as all others. The returned
/// messages point into memory of the drawing: write each before the next is made.
class Drawing {
 public:
  /// `head_height_m`: of the origin of base_link above the ground.
  explicit Drawing(double head_height_m) : head_height_m_(head_height_m) {}
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  /// In the frame odom: the line (namespace `line`), objects and zones with their numbers (`objects`, `zones`,
  /// `numbers`), and recent touches (`touches`). The id of an object or zone is its handle.
  [[nodiscard]] MarkerArray map(const msg::FieldMap& map);
  /// In the frame base_link at the time of the exposure: the line in view, empty if perception sees none.
  [[nodiscard]] MarkerArray line_in_view(const msg::LinePercept& line);
  /// The same for coloured regions that are objects (upright cylinders), zones (flat ones) or undecided (transparent).
  /// A region whose distance is unknown is left out.
  [[nodiscard]] MarkerArray objects_in_view(const msg::ObjectPercepts& objects);
  /// In the frame odom: the mapped line. Each pose looks along the line.
  [[nodiscard]] Path line(const msg::FieldMap& map);
  /// In the frame odom: the path of a task follow_path; empty for every other task.
  [[nodiscard]] Path plan(const msg::TaskCommand& command);

 private:
  void begin(std::int64_t time_ns, const char* frame);
  Marker& add(const char* name_space, int id, int type, std::uint8_t colour, double alpha);
  MarkerArray markers();
  std::vector<geometry_msgs_msg_dds__Point_>& points_of(Marker& marker);
  Path path(std::int64_t time_ns, const double* x_m, const double* y_m, std::size_t count);

  double head_height_m_;
  std_msgs_msg_dds__Header_ header_{};
  std::vector<Marker> markers_;
  std::deque<std::string> texts_;
  std::deque<std::vector<geometry_msgs_msg_dds__Point_>> points_;
  std::vector<geometry_msgs_msg_dds__PoseStamped_> poses_;
};

}  // namespace constrictor::ros_bridge
