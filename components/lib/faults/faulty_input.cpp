#include "faults/faulty_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <stdexcept>

#include "barrier/topic_ops.hpp"
#include "constrictor/archive.hpp"
#include "faults/message_fields.hpp"

namespace constrictor {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): mixes all bits of a number.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

std::string bytes_of(const Sample& sample, std::size_t topic) {
  std::string bytes;
  if (sample.message) topic_ops(topic).append_bytes(sample.message.get(), bytes);
  return bytes;
}

Sample sample_of(const std::string& bytes, std::size_t topic) {
  if (bytes.empty()) return {};
  Sample sample = topic_ops(topic).parse(std::as_bytes(std::span(bytes)));
  if (!sample.message) throw std::runtime_error("checkpoint of a faulty input: damaged");
  return sample;
}

/// The content of one sample with header and robot of another one.
Sample content_of(const Sample& content, const Sample& stamp, std::size_t topic) {
  // Every message begins with the robot's id, in two bytes.
  std::uint16_t robot_id = 0;
  const std::string bytes = bytes_of(stamp, topic);
  std::memcpy(&robot_id, bytes.data(), std::min(sizeof robot_id, bytes.size()));
  return topic_ops(topic).stamp(content.message.get(), *stamp.header, robot_id);
}

}  // namespace

FaultyInput::FaultyInput(const InputSlot* real, bool events, std::vector<TopicFault> faults, std::uint64_t seed)
    : real_(real), faults_(std::move(faults)), seed_(seed), contents_(faults_.size()) {
  slot_.topic = real->topic;
  slot_.events = events;
}

std::uint64_t FaultyInput::draw(const TopicFault& fault, const Sample& sample) const {
  return mixed(mixed(seed_ + fault.number) + sample.header->sequence_number);
}

void FaultyInput::deliver(const Sample& sample) {
  const bool newest = !slot_.latest.header || sample.header->sequence_number > slot_.latest.header->sequence_number;
  if (slot_.events) slot_.fresh.push_back(sample);
  else if (newest) slot_.fresh = {sample};  // an older one that comes late is of no use
  if (newest) slot_.latest = sample;
}

void FaultyInput::suffer(Sample sample, const Tick& tick, const std::function<void(const std::string&)>& refuse) {
  const std::size_t topic = slot_.topic->id;
  int copies = 1;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const TopicFault& fault = faults_[i];
    const bool within = sample.header->time_ns >= fault.from_ns && sample.header->time_ns < fault.until_ns;
    const std::uint64_t drawn = draw(fault, sample);
    if (!within) contents_[i] = fault.kind == TopicFault::Kind::kFreeze ? sample : Sample{};
    if (!within || static_cast<double>(drawn >> 11) * 0x1p-53 >= fault.probability) continue;
    switch (fault.kind) {
      case TopicFault::Kind::kDrop:
        return;
      case TopicFault::Kind::kDelay:
        late_.push_back({tick.index + fault.delay_ticks, sample});
        return;
      case TopicFault::Kind::kLinkDown: {
        // Reliable writers send again what their history contains, as soon as the link is up.
        const std::int64_t rest_ns = fault.until_ns - tick.time_ns;
        if (rest_ns <= 0) break;
        late_.push_back({tick.index + (rest_ns - 1) / tick.period_ns + 1, sample});
        if (late_.size() > slot_.topic->depth) late_.erase(late_.begin());
        return;
      }
      case TopicFault::Kind::kDuplicate:
        copies = 2;
        break;
      case TopicFault::Kind::kFreeze:
        if (contents_[i].message) sample = content_of(contents_[i], sample, topic);
        break;
      case TopicFault::Kind::kBias:
        sample = with_bias(topic, sample, fault.field, fault.amount);
        break;
      case TopicFault::Kind::kCorrupt: {
        std::string bytes = bytes_of(sample, topic);
        const std::size_t header_at = topic_ops(topic).header_at(std::as_bytes(std::span(bytes))).value();
        const std::size_t begin = header_at + kHeaderSize;  // the barrier has used the header already
        if (begin == bytes.size()) break;
        const std::uint64_t bit = mixed(drawn) % (8 * (bytes.size() - begin));
        bytes[begin + bit / 8] = static_cast<char>(bytes[begin + bit / 8] ^ (1 << bit % 8));
        const Sample damaged = topic_ops(topic).parse(std::as_bytes(std::span(bytes)));
        if (!damaged.message) return refuse(fmt::format("{}: damaged by a fault, no message", slot_.topic->name));
        sample = damaged;
        break;
      }
    }
  }
  if (const auto why = topic_ops(topic).validate(sample.message.get()))
    return refuse(fmt::format("{}.{}", slot_.topic->name, *why));
  for (int i = 0; i < copies; ++i) deliver(sample);
}

void FaultyInput::present(const Tick& tick, const std::function<void(const std::string&)>& refuse) {
  slot_.now_tick = real_->now_tick;
  slot_.fresh.clear();
  std::stable_sort(late_.begin(), late_.end(), [](const Late& a, const Late& b) { return a.due < b.due; });
  const auto arrived =
      std::find_if(late_.begin(), late_.end(), [&tick](const Late& late) { return late.due > tick.index; });
  for (auto late = late_.begin(); late != arrived; ++late) deliver(late->sample);
  late_.erase(late_.begin(), arrived);
  for (const Sample& sample : real_->fresh) suffer(sample, tick, refuse);
}

std::string FaultyInput::save() const {
  std::vector<std::pair<std::int64_t, std::string>> late;
  std::vector<std::string> contents;
  const std::size_t topic = slot_.topic->id;
  for (const auto& [due, sample] : late_) late.emplace_back(due, bytes_of(sample, topic));
  for (const auto& content : contents_) contents.push_back(bytes_of(content, topic));
  return save_bytes(late, contents, bytes_of(slot_.latest, topic));
}

void FaultyInput::load(const std::string& bytes) {
  std::vector<std::pair<std::int64_t, std::string>> late;
  std::vector<std::string> contents;
  std::string latest;
  load_bytes(bytes, late, contents, latest);
  const std::size_t topic = slot_.topic->id;
  if (contents.size() != contents_.size()) throw std::runtime_error("checkpoint of a faulty input: of another plan");
  late_.clear();
  for (const auto& [due, sample] : late) late_.push_back({due, sample_of(sample, topic)});
  for (std::size_t i = 0; i < contents.size(); ++i) contents_[i] = sample_of(contents[i], topic);
  slot_.latest = sample_of(latest, topic);
}

}  // namespace constrictor
