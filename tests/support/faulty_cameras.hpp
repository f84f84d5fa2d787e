// The simulated camera with the faults that cameras have.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/camera/camera.hpp"
#include "support/faulty_part.hpp"
#include "support/named_fault.hpp"

namespace constrictor::testing {

/// Each with the check of `constrictor conform camera` that must name it.
inline std::vector<NamedFault> camera_faults() {
  return {{"silent", "arrives", "no camera/image"},
          {"no_model", "arrives", "but no camera/info"},
          {"centre_at_the_corner", "model", "principal point (0.0, 0.0)"},
          {"quaternion_of_zeros", "model", "length 0.000"},
          {"focal_length_of_another", "view", "in the robot file"},
          {"mount_without_rotation", "mount", "rad from the robot file"},
          {"half_images", "size", "320 x 120 pixels"},
          {"slow", "rate", "one in 0.3"},
          {"stamps_ahead", "stamps", "written at tick"},
          {"same_stamp", "stamps", "after 7"},
          {"late", "latency", "0.44 s at most"},
          {"black", "dark", "black images"},
          {"lens_cap", "dark", "of one colour"},
          {"frozen", "frozen", "equal images"},
          {"blue_first", "colours", "with red and blue exchanged"},
          {"still", "moves", "for 0.3"},
          {"upside_down", "upside_down", "lifted by -0.2"},
          {"half_a_turn", "upside_down", "lifted by -0.2"},
          {"mirrored", "mirrored", "to the left"},
          {"zoomed", "scale", "times as far"},
          {"old_pictures", "stamp_of_motion", "behind their stamps"},
          {"silent_after_restart", "restart", "no image within"},
          {"forgets_time", "restart", "after one of tick"}};
}

/// The fault of this name; empty: none.
inline PartFault camera_fault(const std::string& name) {
  PartFault fault;
  const auto image = [&](auto change) { fault.writes = changing(topics::kCameraImage, change); };
  const auto info = [&](auto change) { fault.writes = changing(topics::kCameraInfo, change); };
  const auto pixel = [](msg::CameraImage& i, int u, int v) { return i.data._buffer + 3 * (v * i.width + u); };
  const auto mirror = [pixel](msg::CameraImage& i) {
    for (int v = 0; v < i.height; ++v)
      for (int u = 0; u < i.width / 2; ++u)
        std::swap_ranges(pixel(i, u, v), pixel(i, u, v) + 3, pixel(i, i.width - 1 - u, v));
    return true;
  };
  const auto flip = [pixel](msg::CameraImage& i) {
    for (int v = 0; v < i.height / 2; ++v)
      std::swap_ranges(pixel(i, 0, v), pixel(i, 0, v) + 3 * i.width, pixel(i, 0, i.height - 1 - v));
    return true;
  };
  /// Each image shows what was seen `images` images ago; with 1000 the first one, with other noise each time.
  const auto show_old = [&](std::size_t images) {
    image([images, past = std::deque<std::vector<std::uint8_t>>(), n = 0](msg::CameraImage& i) mutable {
      past.emplace_back(i.data._buffer, i.data._buffer + i.data._length);
      if (past.size() > images + 1) past.pop_front();
      std::memcpy(i.data._buffer, past.front().data(), past.front().size());
      i.data._buffer[0] = static_cast<std::uint8_t>(++n);
      return true;
    });
  };
  const auto is = [&](const char* one) { return name == one; };
  if (is("silent")) fault.writes = [](const TopicInfo&, void*) { return false; };
  if (is("no_model")) info([](msg::CameraInfo&) { return false; });
  if (is("centre_at_the_corner")) info([](msg::CameraInfo& i) { return (i.cx = i.cy = 0.0, true); });
  if (is("quaternion_of_zeros")) info([](msg::CameraInfo& i) { return (i.X_HC.orientation = {}, true); });
  if (is("focal_length_of_another")) info([](msg::CameraInfo& i) { return (i.fx *= 1.6, i.fy *= 1.6, true); });
  if (is("mount_without_rotation")) info([](msg::CameraInfo& i) { return (i.X_HC.orientation = {1, 0, 0, 0}, true); });
  if (is("half_images"))
    image([](msg::CameraImage& i) { return (i.height /= 2, i.data._length /= 2, i.data._maximum /= 2, true); });
  if (is("slow")) image([n = 0](msg::CameraImage&) mutable { return n++ % 3 == 0; });
  if (is("stamps_ahead")) image([](msg::CameraImage& i) { return (i.exposure_tick += 10, true); });
  if (is("same_stamp"))
    image([](msg::CameraImage& i) { return (i.exposure_tick = std::min<std::int64_t>(i.exposure_tick, 7), true); });
  if (is("late")) fault.late_ticks = 20;
  if (is("black") || is("lens_cap"))
    image([level = is("black") ? 1 : 90, n = 0](msg::CameraImage& i) mutable {
      std::memset(i.data._buffer, level, i.data._length);
      i.data._buffer[0] = static_cast<std::uint8_t>(++n);
      return true;
    });
  if (is("frozen"))
    image([first = std::vector<std::uint8_t>()](msg::CameraImage& i) mutable {
      if (first.empty()) first.assign(i.data._buffer, i.data._buffer + i.data._length);
      std::memcpy(i.data._buffer, first.data(), first.size());
      return true;
    });
  if (is("silent_after_restart")) image([restarted = fault.restarted](msg::CameraImage&) { return !*restarted; });
  if (is("forgets_time"))
    image([restarted = fault.restarted](msg::CameraImage& i) {
      if (*restarted) i.exposure_tick -= 100;
      return true;
    });
  if (is("blue_first"))
    image([](msg::CameraImage& i) {
      for (std::uint32_t b = 0; b + 2 < i.data._length; b += 3) std::swap(i.data._buffer[b], i.data._buffer[b + 2]);
      return true;
    });
  if (is("still")) show_old(1000);
  if (is("old_pictures")) show_old(3);
  if (is("upside_down")) image(flip);
  if (is("half_a_turn")) image([flip, mirror](msg::CameraImage& i) { return flip(i) && mirror(i); });
  if (is("mirrored")) image(mirror);
  if (is("zoomed"))
    image([pixel](msg::CameraImage& i) {
      std::vector<std::uint8_t> all(i.data._buffer, i.data._buffer + i.data._length);
      for (int v = 0; v < i.height; ++v) {
        for (int u = 0; u < i.width; ++u) {
          const int from_u = i.width / 2 + (u - i.width / 2) * 2 / 3,
                    from_v = i.height / 2 + (v - i.height / 2) * 2 / 3;
          std::memcpy(pixel(i, u, v), all.data() + 3 * (from_v * i.width + from_u), 3);
        }
      }
      return true;
    });
  return fault;
}

inline ComponentFactory faulty_camera(const std::string& name) {
  return faulty(make_camera_factory(), [name] { return camera_fault(name); });
}

}  // namespace constrictor::testing
