// The views of the camera for viewers: images, the model of the lens, and the percepts as annotations. Pure.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "constrictor/messages.hpp"
#include "views/newest.hpp"

namespace constrictor::views {

/// Frame of the camera's images: C of CameraInfo, which looks along its +z.
inline constexpr const char* kCameraFrame = "camera";

/// The image as ROS 2's sensor_msgs/msg/Image in CDR, or nothing if its number of bytes does not fit its size.
[[nodiscard]] std::optional<std::string> ros_image(const msg::CameraImage& image, const std::string& frame,
                                                   std::uint64_t time_ns);

/// foxglove.CameraCalibration: the lens without distortion, because `camera` and `video_capture` send rectified images.
[[nodiscard]] nlohmann::json camera_calibration(const msg::CameraInfo& info, std::uint64_t time_ns);

/// foxglove.ImageAnnotations, in pixels of the raw image: a box with colour, kind and range for each object and zone,
/// and the line. The line's points lie on the ground, and are projected with the true pose of the head at the exposure;
/// without a pose (a real robot, or a dashboard that has just joined) they are left out.
[[nodiscard]] nlohmann::json image_annotations(const Newest& newest, std::uint64_t time_ns);

}  // namespace constrictor::views
