#include "runtime/replayed_member.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "barrier/topic_ops.hpp"
#include "component/client_requests.hpp"
#include "component/plant_stop.hpp"
#include "constrictor/text.hpp"

namespace constrictor {
namespace {

bool is_image(const TopicInfo& topic) { return topic.type == Description<msg::CameraImage>::kName; }

/// A message with a neutral header; an image without its pixels if `pixels` is false.
std::string comparable(std::uint8_t topic, const std::string& canonical, bool pixels) {
  std::string bytes = neutral_message(topic, canonical);
  if (pixels || !is_image(topics::kInfos[topic])) return bytes;
  const auto image = parse_shared<msg::CameraImage>(std::as_bytes(std::span(bytes)));
  if (!image) return bytes;
  msg::CameraImage bare = *image;
  bare.data = {};
  bytes.clear();
  canonical_bytes(bare, bytes);
  return bytes;
}

}  // namespace

ReplayedMember::ReplayedMember(ComponentFactory factory, Setup setup, bool pixels, const RecordedRequests& requests,
                               OnPublish on_publish)
    : pixels_(pixels), requests_(requests), on_publish_(std::move(on_publish)), robot_id_(setup.robot_id) {
  result_.component = factory.name;
  member_ = std::make_unique<Member>(std::move(factory), std::move(setup), 1, false, static_cast<MemberSink&>(*this));
  is_plant_ = dynamic_cast<Plant*>(&member_->component()) != nullptr;
}

void ReplayedMember::take(const msg::EpochStart& start) {
  if (over()) return;
  ticks_.clear();
  dones_.clear();
  delivered_ = {};
  for (auto* lists : {&recorded_, &replayed_}) {
    for (auto& list : *lists) list.clear();
  }
  for (auto& list : inputs_) list.clear();
  answers_.clear();
  stops_.clear();
  stops_received_ = 0;
  member_->on_epoch({start.run_id, start.epoch}, start.seed);
}

void ReplayedMember::take(const msg::Tick& tick) {
  if (over() || !member_->in_epoch()) return;
  ticks_[tick.index] = newest_tick_ = tick;
  if (!is_plant_) return;
  add_stops(tick.index);
  static_cast<void>(member_->measure(tick.index, tick.time_ns, tick.period_ns));
  member_->publish_sample();
}

void ReplayedMember::take(const TickDone& done) {
  if (over() || !member_->in_epoch() || done.component != member_->name() || done.epoch != member_->epoch()) return;
  dones_.push_back(done);
  advance();
}

void ReplayedMember::take_input(std::uint8_t topic, const Sample& sample) {
  if (over() || !member_->in_epoch()) return;
  inputs_[topic].push_back(sample);
  if (!dones_.empty()) advance();
}

void ReplayedMember::take_output(std::uint8_t topic, const std::string& canonical) {
  if (over()) return;
  if (topic == topics::kRequestAnswer.id || topic == topics::kStopState.id) {
    const auto bytes = std::as_bytes(std::span(canonical));
    if (topic == topics::kRequestAnswer.id) {
      if (const auto answer = parse_shared<msg::RequestAnswer>(bytes)) answers_.push_back(*answer);
    } else if (const auto stop = parse_shared<msg::StopState>(bytes)) {
      stops_.push_back(*stop);
    }
  }
  recorded_[topic].push_back(comparable(topic, canonical, pixels_));
  compare();
}

void ReplayedMember::add_requests(std::int64_t tick) {
  const auto requests = member_->client_requests();
  while (!answers_.empty() && answers_.front().header.tick <= tick) {
    const msg::RequestAnswer answer = answers_.front();
    answers_.pop_front();
    const auto found = requests_.find({text_of(answer.source), answer.request_sequence});
    if (!requests || found == requests_.end() || answer.header.tick != tick) continue;
    const msg::Request& request = found->second;
    const std::string reason = text_of(answer.reason);
    // The run refuses these before `input` sees them.
    if (const auto violation = validate(request)) requests->add_refused(request, *violation);
    else if (reason.starts_with("token:") || reason.starts_with("run_id:")) requests->add_stranger(request, reason);
    else requests->add(request);
  }
}

void ReplayedMember::add_stops(std::int64_t tick) {
  const auto orders = member_->stop_orders();
  while (!stops_.empty() && stops_.front().header.tick <= tick) {
    const msg::StopState stop = stops_.front();
    stops_.pop_front();
    for (; orders && stops_received_ < stop.received; ++stops_received_) orders->add(text_of(stop.source));
  }
}

bool ReplayedMember::deliver(const TickDone& done) {
  for (const auto& [topic, count] : done.consumed) {
    auto& waiting = inputs_[topic];
    while (!waiting.empty() && waiting.front().header->sequence_number <= count) {
      delivered_[topic] = std::max(delivered_[topic], waiting.front().header->sequence_number);
      member_->on_sample(topic, waiting.front());
      waiting.pop_front();
    }
    if (delivered_[topic] >= count) continue;
    if (!waiting.empty()) {
      result_.stopped = fmt::format("sample {} of {}, which the step of tick {} has read, is not in the recording",
                                    count, topics::kInfos[topic].name, done.index);
    }
    return false;
  }
  return true;
}

void ReplayedMember::advance() {
  while (!dones_.empty() && !over()) {
    const TickDone& done = dones_.front();
    const auto tick = ticks_.find(done.index);
    if (done.index <= member_->last_done()) {
      dones_.pop_front();  // a restarted member has repeated the step
      continue;
    }
    if (tick == ticks_.end()) {
      result_.stopped = fmt::format("tick {} is not in the recording", done.index);
      return;
    }
    if (!deliver(done)) return;
    add_requests(done.index);
    msg::Tick present = tick->second;
    present.final_tick = false;  // at the end of a run, some components write files
    member_->on_tick(present);
    replayed_done_.reset();
    if (!member_->try_step()) {
      const MissingInput missing = member_->missing();
      result_.stopped = fmt::format("at tick {}, sample {} of {} is not in the recording", done.index, missing.want,
                                    missing.topic ? missing.topic->name : "?");
      return;
    }
    ++result_.steps;
    compare();
    find_missing(done.index);
    if (!over() && replayed_done_ && replayed_done_->output_hash != done.output_hash) {
      result_.difference = {done.index, "(output hash)", "", "another hash of all that was written",
                            "equal messages, but pixels that are not in the recording differ"};
    }
    ticks_.erase(ticks_.begin(), ticks_.upper_bound(done.index));
    dones_.pop_front();
  }
}

void ReplayedMember::publish(const TopicInfo& topic, const Sample& sample) {
  std::string canonical;
  topic_ops(topic.id).append_bytes(sample.message.get(), canonical);
  replayed_[topic.id].push_back(comparable(topic.id, canonical, pixels_));
  on_publish_(topic, sample);
}

void ReplayedMember::compare() {
  for (std::uint8_t topic = 0; topic < topics::kCount && !over(); ++topic) {
    auto& recorded = recorded_[topic];
    auto& replayed = replayed_[topic];
    while (!recorded.empty() && !replayed.empty() && !over()) {
      compare(topic, recorded.front(), replayed.front());
      recorded.pop_front();
      replayed.pop_front();
    }
  }
}

void ReplayedMember::find_missing(std::int64_t tick) {
  for (std::uint8_t topic = 0; topic < topics::kCount && !over(); ++topic) {
    // compare() has left at most one of the two lists with messages. The recording may be ahead of the replay.
    const bool only_recorded = !recorded_[topic].empty();
    const auto& list = only_recorded ? recorded_[topic] : replayed_[topic];
    if (list.empty() || (!only_recorded && !pixels_ && is_image(topics::kInfos[topic]))) continue;
    const Sample sample = topic_ops(topic).parse(std::as_bytes(std::span(list.front())));
    if (!sample.header || sample.header->tick > tick) continue;
    const std::string message = fmt::format("message {}", sample.header->sequence_number);
    result_.difference = {sample.header->tick, std::string(topics::kInfos[topic].name), "",
                          only_recorded ? message : "no message", only_recorded ? "no message" : message};
  }
}

void ReplayedMember::compare(std::uint8_t topic, const std::string& recorded, const std::string& replayed) {
  ++result_.messages;
  if (recorded == replayed) return;
  const TopicOps& ops = topic_ops(topic);
  const Sample a = ops.parse(std::as_bytes(std::span(recorded)));
  const Sample b = ops.parse(std::as_bytes(std::span(replayed)));
  ReplayDifference difference{b.header ? b.header->tick : -1, std::string(topics::kInfos[topic].name), "", "unreadable",
                              "unreadable"};
  if (a.message && b.message) {
    if (const auto field = ops.difference(a.message.get(), b.message.get())) {
      difference.field = field->path;
      difference.recorded = field->a;
      difference.replayed = field->b;
    }
  }
  result_.difference = difference;
}

void ReplayedMember::conclude() {
  if (over() || !member_->in_epoch() || member_->last_done() < 0) return;
  newest_tick_.final_tick = true;
  member_->on_tick(newest_tick_);
}

ReplayResult ReplayedMember::result() const {
  ReplayResult result = result_;
  if (over()) return result;
  if (!dones_.empty()) {
    for (const auto& [topic, count] : dones_.front().consumed) {
      if (delivered_[topic] >= count) continue;
      result.stopped = fmt::format("sample {} of {}, which the step of tick {} has read, is not in the recording",
                                   count, topics::kInfos[topic].name, dones_.front().index);
    }
  }
  return result;
}

}  // namespace constrictor
