#include "pictures/recorded_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "component/data_path.hpp"
#include "configuration/temporary_folder.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "robot/robot_model.hpp"
#include "runtime/version.hpp"

namespace constrictor::pictures {
namespace {

namespace fs = std::filesystem;

class StoryReader {
 public:
  StoryReader(const fs::path& file, const std::function<void()>& stopped) : stopped_(stopped) { story_.file = file; }

  RecordedStory read() {
    mcap::Reader reader(story_.file);
    mcap::Visitor visitor;
    visitor.message = [this](const auto& channel, const auto& message) { take(channel.topic, message.data); };
    visitor.attachment = [this](const mcap::Attachment& one) {
      if (one.name == "robot.yaml") robot_ = one.data;
    };
    visitor.metadata = [this](const mcap::Metadata& one) {
      if (one.name == "recording") entries_ = one.entries;
    };
    reader.read(visitor);
    if (samples_ == 0)
      throw NoPicture(
          fmt::format("{}: found no messages of the topic {}, accepted the recording of a run "
                      "(`constrictor run --record`, `constrictor record FILE`)",
                      story_.file.string(), topics::kJointState.name));
    complete(reader.contents().library);
    return std::move(story_);
  }

 private:
  /// Whether a message belongs to the last epoch so far; a later one begins a new story.
  bool belongs(const msg::Header& header) {
    if (header.run_id == story_.run_id && header.epoch == story_.epoch) return true;
    if (header.run_id == story_.run_id && header.epoch < story_.epoch) return false;
    RecordedStory next;
    next.file = story_.file;
    next.run_id = header.run_id;
    next.epoch = header.epoch;
    next.epochs = story_.epochs + 1;
    story_ = std::move(next);
    joints_.clear();
    samples_ = 0;
    pixels_ = false;
    return true;
  }

  template <class T>
  std::shared_ptr<const T> message(mcap::Bytes cdr) {
    auto found = message_of<T>(cdr);
    return found && belongs(found->header) ? found : nullptr;
  }

  void take(const std::string& topic, mcap::Bytes cdr) {
    if (topic == topics::kJointState.name) {
      if (const auto joints = message<msg::JointState>(cdr)) take(*joints);
    } else if (topic == topics::kSceneDescription.name) {
      if (const auto scene = message<msg::SceneDescription>(cdr)) {
        story_.scene = scene;
        story_.scenario = text_of(scene->scenario);
        story_.seed = scene->seed;
      }
    } else if (topic == topics::kCameraInfo.name) {
      if (const auto info = message<msg::CameraInfo>(cdr))
        story_.head_camera_m = {info->X_HC.position_m.x, info->X_HC.position_m.y, info->X_HC.position_m.z};
    } else if (topic == topics::kMissionStatus.name) {
      if (const auto mission = message<msg::MissionStatus>(cdr)) take(*mission);
    } else if (topic == topics::kTaskEvent.name) {
      if (const auto event = message<msg::TaskEvent>(cdr)) take(*event);
    } else if (topic == topics::kCameraImage.name && !pixels_) {
      const auto image = message<msg::CameraImage>(cdr);
      pixels_ = image && image->data._length > 0;
    }
  }

  void take(const msg::JointState& joints) {
    constexpr std::size_t kEvery = 5;  // as joint_torques.csv
    if (samples_ == 0) story_.from_s = seconds(joints.header);
    story_.to_s = std::max(story_.to_s, seconds(joints.header));
    if (samples_++ % kEvery == 0) joints_.push_back(joints);
    if (samples_ % 500 == 0) stopped_();
  }

  void take(const msg::MissionStatus& mission) {
    const std::string state = text_of(mission.state);
    if (story_.states.empty() || story_.states.back().second != state)
      story_.states.emplace_back(seconds(mission.header), state);
    if (mission.outcome == msg::kMissionRunning || story_.mission_end_s >= 0.0) return;
    story_.mission_end_s = seconds(mission.header);
    story_.outcome = mission.outcome;
    story_.reason = text_of(mission.reason);
  }

  void take(const msg::TaskEvent& event) {
    if (event.event == msg::kEventNone) return;
    report::Moment moment;
    moment.tick = event.header.tick;
    moment.time_s = seconds(event.header);
    moment.event = event.event;
    moment.colour = event.colour;
    story_.events.push_back(std::move(moment));
  }

  void complete(const std::string& library) {
    const TemporaryFolder folder("replay");
    fs::path robot_file = default_robot_file();  // of a recording without its robot
    if (!robot_.empty()) {
      robot_file = folder.path() / "robot.yaml";
      std::ofstream(robot_file, std::ios::binary) << robot_;
    }
    for (const std::size_t joint : load_robot(robot_file).yaw_joints()) {
      std::vector<double> series;
      for (const auto& joints : joints_) series.push_back(joint < joints.joint_count ? joints.torque_nm[joint] : 0.0);
      story_.torques.torque_nm.push_back(std::move(series));
    }
    for (const auto& joints : joints_) story_.torques.time_s.push_back(seconds(joints.header));
    for (auto& moment : story_.events) moment.state = story_.state_at(moment.time_s);
    story_.images = Images::kRecorded;
    if (pixels_) return;
    const auto entry = [this](const char* name) {
      const auto found = entries_.find(name);
      return found == entries_.end() ? std::string() : found->second;
    };
    const std::string release = fmt::format("constrictor {}", kVersion);
    story_.images = Images::kNone;
    if (entry("kind") != "run") {
      story_.no_images = "the recording has no images; record them with `constrictor record` without --images off";
    } else if (!story_.scene) {
      story_.no_images =
          "the recording has no images, and those of a real camera cannot be computed again; record "
          "them with --images on";
    } else if (library != release) {
      story_.no_images = fmt::format(
          "the recording has no images, and only its own release, '{}', can compute them again; this is '{}'", library,
          release);
    } else {
      story_.images = Images::kComputed;
    }
  }

  const std::function<void()>& stopped_;
  RecordedStory story_;
  mcap::Texts entries_;
  std::string robot_;
  std::vector<msg::JointState> joints_;
  std::size_t samples_ = 0;
  bool pixels_ = false;
};

}  // namespace

std::string RecordedStory::state_at(double time_s) const {
  const auto after = std::upper_bound(states.begin(), states.end(), time_s,
                                      [](double time, const auto& state) { return time < state.first; });
  return after == states.begin() ? std::string() : std::prev(after)->second;
}

RecordedStory read_story(const fs::path& file, const std::function<void()>& stopped) {
  return StoryReader(file, stopped).read();
}

}  // namespace constrictor::pictures
