#include "views/recorded_views.hpp"

#include <nlohmann/json.hpp>

#include "constrictor/topics.hpp"
#include "recording/message_cdr.hpp"
#include "views/camera_views.hpp"
#include "views/foxglove_json.hpp"
#include "views/views.hpp"

namespace constrictor::views {
namespace {

constexpr std::uint64_t kScenePeriod_ns = 50'000'000;

/// Takes over the message if the topic is that of `to`. Returns whether it is.
template <class T>
bool keep_if(const std::string& topic, const Topic<T>& wanted, mcap::Bytes cdr, std::optional<T>& to) {
  if (topic != wanted.name) return false;
  if (const auto message = message_of<T>(cdr)) keep(to, *message);
  return true;
}

}  // namespace

void RecordedViews::write(View view, std::uint64_t time_ns, const nlohmann::json& message) {
  write_(view, time_ns, message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void RecordedViews::write_image(View view, const msg::CameraImage& image, std::uint64_t time_ns) {
  if (const auto cdr = ros_image(image, kCameraFrame, time_ns)) write_(view, time_ns, *cdr);
}

void RecordedViews::take_world(const msg::WorldState& world, std::uint64_t time_ns) {
  if (!keep_world(newest_, world)) return;
  align(newest_);
  // A recording of several runs, or of a run that was reset, may go back in time.
  if (scene_written_ && time_ns >= scene_ns_ && time_ns - scene_ns_ < kScenePeriod_ns) return;
  scene_ns_ = time_ns;
  scene_written_ = true;
  write(View::kScene, time_ns, scene_update(newest_, time_ns));
  write(View::kTransforms, time_ns, frame_transforms(newest_, time_ns));
}

void RecordedViews::take(const std::string& topic, mcap::Bytes cdr, std::uint64_t time_ns) {
  if (keep_if(topic, topics::kSceneDescription, cdr, newest_.scene)) return;
  if (keep_if(topic, topics::kJointState, cdr, newest_.joints)) return;
  if (keep_if(topic, topics::kContactState, cdr, newest_.contacts)) return;
  if (keep_if(topic, topics::kRobotPose, cdr, newest_.pose)) return align(newest_);
  if (keep_if(topic, topics::kFieldMap, cdr, newest_.map)) return;
  if (keep_if(topic, topics::kLinePercept, cdr, newest_.line)) return;
  if (keep_if(topic, topics::kCameraInfo, cdr, newest_.camera)) {
    if (newest_.camera) write(View::kCalibration, time_ns, camera_calibration(*newest_.camera, time_ns));
  } else if (keep_if(topic, topics::kObjectPercepts, cdr, newest_.blobs)) {
    write(View::kAnnotations, time_ns, image_annotations(newest_, time_ns));
  } else if (topic == topics::kWorldState.name) {
    if (const auto world = message_of<msg::WorldState>(cdr)) take_world(*world, time_ns);
  } else if (topic == topics::kTaskEvent.name) {
    const auto event = message_of<msg::TaskEvent>(cdr);
    if (event && keep_event(newest_, *event)) write(View::kLog, time_ns, log_of(*event, time_ns));
  } else if (topic == barrier_topics::kLog.name) {
    const auto line = message_of<msg::LogLine>(cdr);
    if (!line || validate(*line)) return;
    auto log = log_of(*line);
    log["timestamp"] = stamp(time_ns);  // the time of the recording, which may be simulated
    write(View::kLog, time_ns, log);
  } else if (topic == topics::kCameraImage.name || topic == topics::kProcessedImage.name) {
    const View view = topic == topics::kCameraImage.name ? View::kCamera : View::kProcessed;
    if (const auto image = message_of<msg::CameraImage>(cdr)) write_image(view, *image, time_ns);
  }
}

}  // namespace constrictor::views
