// The project's perception with the faults that perceptions have.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "perception/perception.hpp"
#include "support/faulty_part.hpp"
#include "support/named_fault.hpp"

namespace constrictor::testing {

/// Each with the check of `constrictor conform perception` that must name it.
inline std::vector<NamedFault> perception_faults() {
  return {{"silent", "arrives", "no answer"},
          {"blind_to_objects", "arrives", "no answer"},
          {"skips", "every_image", "of 10 images"},
          {"stamps_anew", "stamp", "for an image of tick"},
          {"late", "answer", "s at most"},
          {"picture_of_other_size", "picture", "for an image of 320 x 240"},
          {"sees_ghosts", "empty", "a line"},
          {"blue_first", "line", "no line is visible"},
          {"mirrored", "line_sign", "for a line at"},
          {"millimetres", "line_offset", "for a line at"},
          {"heading_to_the_right", "line_heading", "for a line that leads"},
          {"bends_right", "line_curvature", "for a line of"},
          {"points_to_the_right", "line_points", "is not on the line"},
          {"far_points_first", "line_points", "nearer than the one before"},
          {"never_ends", "line_end", "no end is seen"},
          {"ignores_attitude", "attitude", "with a pitch"},
          {"ignores_task", "line_colour", "a blue line is visible"},
          {"doubles", "object", "2 objects"},
          {"wrong_colour", "object_colour", "for an object of colour"},
          {"all_objects", "object_kind", "a zone"},
          {"no_probability", "object_probability", "for an object"},
          {"bearing_to_the_right", "bearing_sign", "for an object at"},
          {"bearing_in_degrees", "bearing", "for an object at"},
          {"range_from_camera", "range", "for the object at"},
          {"half_width", "width", "for the object of"},
          {"height_above_camera", "height", "for the object of"},
          {"smallest_first", "largest_first", "of the image"},
          {"rows_from_below", "box", "for an object at"},
          {"cut_right", "cut", "right true"},
          {"uses_small_images", "wrong_size", "are used"},
          {"counts_nothing", "wrong_size", "nothing is counted"},
          {"uses_bad_model", "bad_model", "are used"},
          {"never_frozen", "frozen", "are used"},
          {"random", "repeatable", "another line"},
          {"jumps_after_restart", "restart", "another line"}};
}

/// The fault of this name; empty: none. `memory` outlives the epochs.
inline PartFault perception_fault(const std::string& name, const std::shared_ptr<std::uint64_t>& memory) {
  PartFault fault;
  const auto line = [&](auto change) { fault.writes = changing(topics::kLinePercept, change); };
  const auto objects = [&](auto change) { fault.writes = changing(topics::kObjectPercepts, change); };
  const auto blobs = [&](auto change) {
    objects([change](msg::ObjectPercepts& o) mutable {
      for (int i = 0; i < o.blob_count; ++i) change(o.blobs[i]);
    });
  };
  const auto image = [&](auto change) { fault.reads = changing(topics::kCameraImage, change); };
  const auto is = [&](const char* one) { return name == one; };
  if (is("silent")) fault.writes = [](const TopicInfo&, void*) { return false; };
  if (is("blind_to_objects"))
    fault.writes = [](const TopicInfo& topic, void*) { return topic.id != topics::kObjectPercepts.id; };
  if (is("skips"))
    fault.reads = [n = 0](const TopicInfo& topic, void*, std::int64_t) mutable {
      return topic.id != topics::kCameraImage.id || ++n % 4 != 0;
    };
  if (is("stamps_anew")) line([](msg::LinePercept& l) { l.exposure_tick += 2; });
  if (is("late")) fault.late_ticks = 12;
  if (is("picture_of_other_size"))
    fault.writes = changing(topics::kProcessedImage, [](msg::CameraImage& picture) {
      picture.height /= 2;
      picture.data._length /= 2;
    });
  if (is("sees_ghosts"))
    line([](msg::LinePercept& l) {
      if (!l.visible) l.offset_m = 0.1;
      l.visible = true;
    });
  if (is("blue_first"))
    image([](msg::CameraImage& i) {
      for (std::uint32_t b = 0; b + 2 < i.data._length; b += 3) std::swap(i.data._buffer[b], i.data._buffer[b + 2]);
      return true;
    });
  if (is("mirrored"))
    image([](msg::CameraImage& i) {
      for (int v = 0; v < i.height; ++v) {
        std::uint8_t* row = i.data._buffer + v * i.width * 3;
        for (int u = 0; u < i.width / 2; ++u)
          std::swap_ranges(row + 3 * u, row + 3 * u + 3, row + 3 * (i.width - 1 - u));
      }
      return true;
    });
  if (is("millimetres")) line([](msg::LinePercept& l) { l.offset_m *= 1000.0; });
  if (is("heading_to_the_right")) line([](msg::LinePercept& l) { l.heading_rad = -l.heading_rad; });
  if (is("bends_right")) line([](msg::LinePercept& l) { l.curvature_1_m = -l.curvature_1_m; });
  if (is("points_to_the_right"))
    line([](msg::LinePercept& l) {
      for (double& y : l.y_m) y = -y;
    });
  if (is("far_points_first"))
    line([](msg::LinePercept& l) {
      std::reverse(l.x_m, l.x_m + l.point_count);
      std::reverse(l.y_m, l.y_m + l.point_count);
    });
  if (is("never_ends")) line([](msg::LinePercept& l) { l.end_visible = false; });
  if (is("ignores_attitude"))
    fault.reads = [](const TopicInfo& topic, void*, std::int64_t) { return topic.id != topics::kImuState.id; };
  if (is("ignores_task"))
    fault.reads = [](const TopicInfo& topic, void*, std::int64_t) { return topic.id != topics::kTaskStatus.id; };
  if (is("doubles"))
    objects([](msg::ObjectPercepts& o) {
      if (o.blob_count == 1) o.blobs[o.blob_count++] = o.blobs[0];
    });
  if (is("wrong_colour"))
    blobs([](msg::Blob& b) {
      if (b.colour == msg::kColourYellow) b.colour = msg::kColourGreen;
    });
  if (is("all_objects")) blobs([](msg::Blob& b) { b.kind = msg::kBlobObject; });
  if (is("no_probability")) blobs([](msg::Blob& b) { b.object_probability = 0.0; });
  if (is("bearing_to_the_right")) blobs([](msg::Blob& b) { b.bearing_rad = -b.bearing_rad; });
  if (is("bearing_in_degrees")) blobs([](msg::Blob& b) { b.bearing_rad *= 180.0 / M_PI; });
  if (is("range_from_camera")) blobs([](msg::Blob& b) { b.range_m -= 0.09; });
  if (is("half_width")) blobs([](msg::Blob& b) { b.width_m *= 0.5; });
  if (is("height_above_camera")) blobs([](msg::Blob& b) { b.height_m -= 0.085; });
  if (is("smallest_first")) objects([](msg::ObjectPercepts& o) { std::reverse(o.blobs, o.blobs + o.blob_count); });
  if (is("rows_from_below"))
    blobs([](msg::Blob& b) {
      const std::uint16_t v_min = b.v_min;
      b.v_min = static_cast<std::uint16_t>(240 - b.v_max);
      b.v_max = static_cast<std::uint16_t>(240 - v_min);
    });
  if (is("cut_right")) blobs([](msg::Blob& b) { std::swap(b.cut_left, b.cut_right); });
  if (is("uses_small_images"))
    image([noise = std::uint8_t{0}, bytes = std::vector<std::uint8_t>(320 * 240 * 3)](msg::CameraImage& i) mutable {
      if (i.width == 320) return true;
      std::fill(bytes.begin(), bytes.end(), ++noise);
      i.data._buffer = bytes.data();  // the message does not own it
      i.data._length = i.data._maximum = static_cast<std::uint32_t>(bytes.size());
      i.width = 320;
      i.height = 240;
      return true;
    });
  if (is("counts_nothing")) image([](msg::CameraImage& i) { return i.width == 320; });
  if (is("uses_bad_model"))
    fault.reads = changing(topics::kCameraInfo, [](const msg::CameraInfo& info) { return info.fx > 0.0; });
  if (is("never_frozen"))
    image([n = std::uint8_t{0}](msg::CameraImage& i) mutable {
      i.data._buffer[0] = ++n;
      return true;
    });
  if (is("jumps_after_restart"))
    line([restarted = fault.restarted](msg::LinePercept& l) {
      if (*restarted) l.offset_m += 0.1;
    });
  if (is("random"))
    line([memory](msg::LinePercept& l) {
      if (l.point_count > 0) l.y_m[0] += 1e-9 * static_cast<double>(++*memory);
    });
  return fault;
}

inline ComponentFactory faulty_perception(const std::string& name) {
  auto memory = std::make_shared<std::uint64_t>(0);
  return faulty(make_perception_factory(), [name, memory] { return perception_fault(name, memory); });
}

}  // namespace constrictor::testing
