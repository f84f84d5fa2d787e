// The topics that are made for viewers. The dashboard sends them live; `constrictor foxglove` adds them to a recording.
#pragma once

#include <array>
#include <cstddef>

namespace constrictor::views {

enum class View : std::size_t { kScene, kTransforms, kCamera, kProcessed, kAnnotations, kCalibration, kLog };

struct ViewTopic {
  const char* topic;
  const char* encoding;  ///< of the messages
  const char* schema_name;
  const char* schema_encoding;
  const char* schema;
};

/// Viewers know the schemas of Foxglove by their names.
inline constexpr const char* kAnyObject = R"({"type":"object","properties":{}})";
/// The type of ROS 2, as its message files say it.
inline constexpr const char* kImageSchema =
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
    "uint8[] data\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

/// The topics, in the order of `View`.
inline constexpr std::array kViewTopics = {
    ViewTopic{"view/scene", "json", "foxglove.SceneUpdate", "jsonschema", kAnyObject},
    ViewTopic{"view/transforms", "json", "foxglove.FrameTransforms", "jsonschema", kAnyObject},
    ViewTopic{"view/camera", "cdr", "sensor_msgs/msg/Image", "ros2msg", kImageSchema},
    ViewTopic{"view/processed", "cdr", "sensor_msgs/msg/Image", "ros2msg", kImageSchema},
    ViewTopic{"view/annotations", "json", "foxglove.ImageAnnotations", "jsonschema", kAnyObject},
    ViewTopic{"view/calibration", "json", "foxglove.CameraCalibration", "jsonschema", kAnyObject},
    ViewTopic{"view/log", "json", "foxglove.Log", "jsonschema", kAnyObject}};

}  // namespace constrictor::views
