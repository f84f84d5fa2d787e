#include "barrier/input_buffer.hpp"

#include <algorithm>

namespace constrictor {

InputBuffer::InputBuffer(const TopicInfo& topic, bool events) {
  slot_.topic = &topics::kInfos.at(topic.id);
  slot_.events = events;
}

InputBuffer::Arrival InputBuffer::classify(const msg::Header& header) const {
  if (header.sequence_number < std::max<std::uint64_t>(last_valid_, 1)) return Arrival::kDuplicate;
  if (header.sequence_number > farthest()) return Arrival::kTooFarAhead;
  const auto known = samples_.find(header.sequence_number);
  if (known == samples_.end()) return Arrival::kNew;
  const bool seen = header.sequence_number <= consumed_;
  return seen || known->second.sample.header->incarnation >= header.incarnation ? Arrival::kDuplicate
                                                                                : Arrival::kReplacement;
}

void InputBuffer::keep(const Sample& sample, bool valid) { samples_[sample.header->sequence_number] = {sample, valid}; }

std::uint64_t InputBuffer::newest_valid(std::uint64_t target) const {
  for (auto at = samples_.upper_bound(target); at != samples_.begin();) {
    --at;
    if (at->second.valid) return at->first;
  }
  return 0;
}

bool InputBuffer::complete(const msg::Tick& tick) const {
  const std::size_t topic = slot_.topic->id;
  const std::uint64_t target = tick.visible[topic];
  if (target == 0 || tick.realtime) return true;
  const auto newest = samples_.find(target);
  if (newest == samples_.end() || newest->second.sample.header->incarnation != tick.incarnations[topic]) return false;
  // After a restart the previous valid sample, which stays in force, may still be on its way.
  if (!newest->second.valid && last_valid_ > 0 && newest_valid(target) == 0) return false;
  if (!slot_.events) return true;
  for (std::uint64_t sequence = consumed_ + 1; sequence < target; ++sequence) {
    if (!samples_.contains(sequence)) return false;
  }
  return true;
}

bool InputBuffer::complete_again() const {
  return last_valid_ == 0 || samples_.lower_bound(last_valid_) != samples_.end();
}

void InputBuffer::present_again(std::int64_t tick) {
  slot_.now_tick = tick;
  slot_.fresh.clear();
  const auto newest = samples_.lower_bound(last_valid_);
  if (last_valid_ > 0 && newest != samples_.end()) slot_.latest = newest->second.sample;
}

void InputBuffer::present(const msg::Tick& tick) {
  const std::uint64_t target = tick.realtime ? this->newest() : tick.visible[slot_.topic->id];
  slot_.now_tick = tick.index;
  slot_.fresh.clear();
  const std::uint64_t newest = newest_valid(target);
  if (newest > 0) slot_.latest = samples_.at(newest).sample;
  if (slot_.events) {
    for (auto at = samples_.upper_bound(consumed_); at != samples_.end() && at->first <= target; ++at) {
      if (at->second.valid) slot_.fresh.push_back(at->second.sample);
    }
  } else if (newest > consumed_) {
    slot_.fresh.push_back(slot_.latest);
  }
  consumed_ = std::max(consumed_, target);
  last_valid_ = std::max(last_valid_, newest);
  samples_.erase(samples_.begin(), samples_.lower_bound(last_valid_));
}

}  // namespace constrictor
