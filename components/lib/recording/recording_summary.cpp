#include "recording/recording_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"

namespace constrictor {
namespace {

constexpr std::uint64_t kShortestForRate_ns = 100'000'000;  // in less time, two messages by chance make a rate

using EpochKey = std::pair<std::uint64_t, std::uint32_t>;  // run id, epoch

/// The numbers of one topic's messages in one epoch.
struct Sequence {
  std::uint64_t first = 0;
  std::uint64_t newest = 0;
  std::uint64_t left_out = 0;
  void add(std::uint64_t number) {
    if (newest == 0) first = number;
    else if (number > newest + 1) left_out += number - newest - 1;
    else if (number <= newest) return;  // a restarted member repeats its last step
    newest = number;
  }
};

class Summariser {
 public:
  explicit Summariser(const std::filesystem::path& file) : reader_(file) {
    mcap::Visitor visitor;
    visitor.message = [this](const auto& channel, const auto& message) { take(channel, message); };
    visitor.attachment = [this](const mcap::Attachment& one) {
      summary_.attachments.emplace_back(printable(one.name), one.data.size());
    };
    visitor.metadata = [this](const mcap::Metadata& one) {
      if (one.name == "recording") summary_.recording = one.entries;
      else if (one.name == "dropped") summary_.dropped = one.entries;
      else if (one.name == "recovered") summary_.recovered = one.entries;
      else if (one.name == "gaps") gaps_ = one.entries;
    };
    reader_.read(visitor);
    summary_.file_bytes = std::filesystem::file_size(file);
    finish();
  }
  RecordingSummary take_result() { return std::move(summary_); }

 private:
  void take(const mcap::Channel& channel, const mcap::Message& message) {
    RecordedTopic& topic = topics_[channel.topic];
    if (topic.messages++ == 0) {
      topic.name = printable(channel.topic);
      const auto type = channel.metadata.find("dds_type");
      // Topics that are not DDS's, such as those of `constrictor foxglove`, have the type that their schema names.
      if (type != channel.metadata.end()) topic.type = printable(type->second);
      else if (const mcap::Schema* schema = reader_.schema_of(channel)) topic.type = printable(schema->name);
      const auto why = channel.metadata.find("no_schema");
      if (channel.schema_id == 0)
        topic.no_schema = why == channel.metadata.end() ? "not described" : printable(why->second);
    }
    if (!began_ns_) began_ns_ = message.log_time;
    if (message.publish_time < *began_ns_) ++topic.history;
    else if (topic.messages == topic.history + 1) topic.first_ns = message.log_time;
    topic.bytes += message.data.size();
    topic.last_ns = std::max(topic.last_ns, message.log_time);
    const auto info = std::find_if(topics::kInfos.begin(), topics::kInfos.end(),
                                   [&](const TopicInfo& one) { return one.name == channel.topic; });
    if (info != topics::kInfos.end()) take_member(*info, message);
    else if (channel.topic == barrier_topics::kTick.name) take_tick(message);
    else if (channel.topic == barrier_topics::kEpochStart.name) take_epoch(message);
  }

  void take_member(const TopicInfo& info, const mcap::Message& message) {
    const auto header = find_codec(info.type)->header(message.data);
    if (!header) return;
    sequences_[{header->run_id, header->epoch}][info.id].add(header->sequence_number);
    if (info.id == topics::kTaskEvent.id) take_event(message);
    if (info.id == topics::kMissionStatus.id) {
      if (const auto status = message_of<msg::MissionStatus>(message.data)) mission_ = *status;
    }
  }
  void take_event(const mcap::Message& message) {
    const auto event = message_of<msg::TaskEvent>(message.data);
    if (!event || event->event == msg::kEventNone) return;
    std::string text = words_of(constants::kEvent, event->event);
    if (event->colour != msg::kColourUnknown) text += fmt::format(" ({})", name_of(constants::kColour, event->colour));
    if (event->detail[0] != '\0') text += ": " + printable(event->detail);
    summary_.events.push_back({event->header.epoch, static_cast<double>(event->header.time_ns) * 1e-9, text});
  }
  RecordedEpoch& epoch_of(std::uint64_t run_id, std::uint32_t epoch) {
    RecordedEpoch& found = epochs_[{run_id, epoch}];
    found.run_id = run_id;
    found.epoch = epoch;
    return found;
  }
  void take_tick(const mcap::Message& message) {
    const auto tick = message_of<msg::Tick>(message.data);
    if (!tick) return;
    RecordedEpoch& epoch = epoch_of(tick->run_id, tick->epoch);
    if (epoch.first_tick < 0) epoch.first_tick = tick->index;
    if (tick->index <= epoch.last_tick) return;
    ++epoch.ticks;
    epoch.last_tick = tick->index;
    epoch.end_s = static_cast<double>(tick->time_ns) * 1e-9;
    visible_[{tick->run_id, tick->epoch}] = *tick;
  }
  void take_epoch(const mcap::Message& message) {
    const auto start = message_of<msg::EpochStart>(message.data);
    if (start) epoch_of(start->run_id, start->epoch).seed = start->seed;
  }

  [[nodiscard]] std::string entry(const char* name) const {
    const auto found = summary_.recording.find(name);
    return found == summary_.recording.end() ? "" : found->second;
  }

  void count_missing() {
    const bool whole_run = entry("kind") == "run";
    const bool no_images = entry("images") == "off";
    for (auto& [key, sequences] : sequences_) visible_.try_emplace(key);
    for (const auto& [key, tick] : visible_) {
      for (const auto& info : topics::kInfos) {
        if (no_images && info.type == Description<msg::CameraImage>::kName) continue;
        const Sequence& sequence = sequences_[key][info.id];
        std::uint64_t missing = sequence.left_out;
        if (whole_run) {
          if (sequence.newest > 0) missing += sequence.first - 1;
          if (tick.visible[info.id] > sequence.newest) missing += tick.visible[info.id] - sequence.newest;
        }
        if (missing == 0) continue;
        RecordedTopic& topic = topics_[std::string(info.name)];
        topic.name = info.name;
        topic.missing += missing;
      }
    }
    for (const auto& [name, count] : gaps_) {
      // Members' topics have been counted above by their numbers.
      const bool of_member = std::any_of(topics::kInfos.begin(), topics::kInfos.end(),
                                         [&wanted = name](const TopicInfo& one) { return one.name == wanted; });
      const bool is_number = !count.empty() && count.size() < 19 && count.find_first_not_of("0123456789") == count.npos;
      if (of_member || !is_number) continue;
      RecordedTopic& topic = topics_[name];
      topic.name = printable(name);
      topic.missing += std::stoull(count);
    }
    bool all_ticks = !epochs_.empty();
    for (const auto& [key, epoch] : epochs_) {
      all_ticks =
          all_ticks && (epoch.last_tick < 0 ||
                        (epoch.first_tick == 0 && epoch.ticks == static_cast<std::uint64_t>(epoch.last_tick) + 1));
    }
    summary_.proven = whole_run && all_ticks && entry("pace") == "lockstep" && summary_.dropped.empty() &&
                      summary_.incomplete.empty();
  }

  void finish() {
    summary_.incomplete = reader_.incomplete();
    const mcap::Contents& contents = reader_.contents();
    summary_.chunks = contents.chunks.size();
    summary_.messages = contents.statistics.message_count;
    summary_.start_ns = contents.statistics.start_time;
    summary_.end_ns = contents.statistics.end_time;
    count_missing();
    for (auto& [name, topic] : topics_) summary_.topics.push_back(std::move(topic));
    for (auto& [key, epoch] : epochs_) summary_.epochs.push_back(epoch);
    if (mission_) {
      summary_.mission =
          fmt::format("{}, state {}, {} of {} objects delivered{}{}", name_of(constants::kMission, mission_->outcome),
                      printable(mission_->state), mission_->delivered_count, mission_->object_count,
                      mission_->reason[0] == '\0' ? "" : ": ", printable(mission_->reason));
    }
  }

  mcap::Reader reader_;
  RecordingSummary summary_;
  std::optional<std::uint64_t> began_ns_;  ///< log time of the first message
  std::map<std::string, RecordedTopic> topics_;
  std::map<EpochKey, RecordedEpoch> epochs_;
  std::map<EpochKey, msg::Tick> visible_;  ///< the last tick of each epoch
  std::map<EpochKey, std::map<std::uint8_t, Sequence>> sequences_;
  mcap::Texts gaps_;
  std::optional<msg::MissionStatus> mission_;
};

}  // namespace

double RecordedTopic::rate_hz() const {
  const std::uint64_t live = messages - history;
  if (live < 2 || last_ns < first_ns + kShortestForRate_ns) return 0.0;
  return static_cast<double>(live - 1) * 1e9 / static_cast<double>(last_ns - first_ns);
}

std::uint64_t RecordingSummary::missing() const {
  std::uint64_t sum = 0;
  for (const auto& topic : topics) sum += topic.missing;
  return sum;
}

RecordingSummary summarise_recording(const std::filesystem::path& file) { return Summariser(file).take_result(); }

}  // namespace constrictor
