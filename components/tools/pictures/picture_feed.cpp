#include "pictures/picture_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>

#include "constrictor/image.hpp"
#include "constrictor/topics.hpp"
#include "host/known_components.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/component_replay.hpp"
#include "sim/report/moments.hpp"

namespace constrictor::pictures {
namespace {

// [s] An image that is computed again, and the processed image of an exposure, come a few ticks after their time. The
// next picture of perception comes up to a second after its time.
constexpr double kPatience_s = 1.5;

/// The newest element up to a time, without those before it.
template <class T>
std::shared_ptr<const T> newest(std::deque<std::shared_ptr<const T>>& waiting, double time_s) {
  while (waiting.size() > 1 && seconds(waiting[1]->header) <= time_s + 1e-9) waiting.pop_front();
  return waiting.empty() || seconds(waiting.front()->header) > time_s + 1e-9 ? nullptr : waiting.front();
}

class Feed {
 public:
  Feed(const RecordedStory& story, const std::vector<double>& times_s, Choice choice,
       const std::function<void(const Seen&)>& use)
      : story_(story), times_s_(times_s), choice_(choice), use_(use) {}

  void take(const mcap::Channel& channel, const mcap::Message& message) {
    if (channel.topic == topics::kJointState.name) {  // the clock
      const auto header = find_codec(topics::kJointState.type)->header(message.data);
      if (header && mine(*header)) show(seconds(*header) - kPatience_s);
    } else if (channel.topic == topics::kWorldState.name) {
      auto world = message_of<msg::WorldState>(message.data);
      if (world && mine(world->header)) worlds_.push_back(std::move(world));
    } else if (story_.images == Images::kRecorded &&
               (channel.topic == topics::kCameraImage.name || channel.topic == topics::kProcessedImage.name)) {
      if (const auto image = message_of<msg::CameraImage>(message.data)) take(channel.topic, image);
    }
  }
  void take(std::string_view topic, const std::shared_ptr<const msg::CameraImage>& image) {
    if (!mine(image->header) || !image_violation(*image).empty()) return;
    if (topic == topics::kCameraImage.name) cameras_.push_back(image);
    if (topic == topics::kProcessedImage.name) processed_.push_back(image);
    if (choice_ != Choice::kPair) return;
    // Those that no moment needs any more, because all until then have been shown, are given up.
    constexpr double kKept_s = 2.0 * kPatience_s;
    if (topic == topics::kCameraImage.name) raws_[image->exposure_tick] = image;
    const double now_s = seconds(image->header);
    std::erase_if(raws_, [&](const auto& raw) { return seconds(raw.second->header) < now_s - kKept_s; });
    while (!processed_.empty() && seconds(processed_.front()->header) < now_s - kKept_s) processed_.pop_front();
  }
  void finish() { show(times_s_.empty() ? 0.0 : times_s_.back()); }

 private:
  [[nodiscard]] bool mine(const msg::Header& header) const {
    return header.run_id == story_.run_id && header.epoch == story_.epoch;
  }

  void show(double until_s) {
    for (; next_ < times_s_.size() && times_s_[next_] <= until_s + 1e-9; ++next_) {
      Seen seen;
      seen.time_s = times_s_[next_];
      seen.world = newest(worlds_, seen.time_s);
      seen.camera = newest(cameras_, seen.time_s);
      if (seen.camera && choice_ == Choice::kPair) pair(seen);
      if (seen.camera && choice_ == Choice::kNewest) {
        const auto exposure = seen.camera->exposure_tick;
        while (processed_.size() > 1 && processed_[1]->exposure_tick <= exposure) processed_.pop_front();
        if (!processed_.empty() && processed_.front()->exposure_tick <= exposure) seen.processed = processed_.front();
      }
      use_(seen);
    }
  }

  void pair(Seen& seen) const {
    const std::int64_t at = seen.camera->exposure_tick;
    for (const auto& processed : processed_) {
      const std::int64_t exposure = processed->exposure_tick;
      if (std::abs(exposure - at) > report::kSameMoment_ticks) continue;
      const auto raw = raws_.find(exposure);
      if (raw == raws_.end()) continue;
      seen.camera = raw->second;
      seen.processed = processed;
      if (exposure >= at) return;
    }
  }

  const RecordedStory& story_;
  const std::vector<double>& times_s_;
  Choice choice_;
  const std::function<void(const Seen&)>& use_;
  std::size_t next_ = 0;
  std::deque<std::shared_ptr<const msg::WorldState>> worlds_;
  std::deque<std::shared_ptr<const msg::CameraImage>> cameras_, processed_;
  std::map<std::int64_t, std::shared_ptr<const msg::CameraImage>> raws_;  // by exposure, for pairs
};

}  // namespace

std::string feed_pictures(const RecordedStory& story, const std::vector<double>& times_s, Choice choice,
                          const std::function<void(const Seen&)>& use) {
  Feed feed(story, times_s, choice, use);
  const auto take = [&](const mcap::Channel& channel, const mcap::Message& message) { feed.take(channel, message); };
  std::string wrong;
  if (story.images == Images::kComputed) {
    ReplayHooks hooks{take, [&](const TopicInfo& topic, const auto& image) { feed.take(topic.name, image); }};
    const auto find = [](const std::string& name) -> std::optional<ComponentFactory> {
      const auto known = known_components().find(name);
      if (known == known_components().end()) return std::nullopt;
      return known->second();
    };
    for (const auto& result : replay_components(story.file, {"camera", "perception"}, find, {}, hooks)) {
      if (!result.stopped.empty()) wrong = fmt::format("{}: {}", result.component, result.stopped);
      if (result.difference)
        wrong = fmt::format("{}: computes something else than it did in the run, from tick {} on", result.component,
                            result.difference->tick);
    }
  } else {
    mcap::Reader(story.file).read({take, {}, {}});
  }
  feed.finish();
  return wrong;
}

}  // namespace constrictor::pictures
