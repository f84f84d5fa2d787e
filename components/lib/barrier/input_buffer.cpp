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
  const auto known = find(header.sequence_number);
  if (known == samples_.end()) return Arrival::kNew;
  const bool seen = header.sequence_number <= consumed_;
  return seen || known->sample.header->incarnation >= header.incarnation ? Arrival::kDuplicate : Arrival::kReplacement;
}

InputBuffer::Entries::const_iterator InputBuffer::from(std::uint64_t sequence) const {
  return std::lower_bound(samples_.begin(), samples_.end(), sequence,
                          [](const Entry& entry, std::uint64_t wanted) { return entry.sequence() < wanted; });
}

InputBuffer::Entries::const_iterator InputBuffer::after(std::uint64_t sequence) const {
  return std::upper_bound(samples_.begin(), samples_.end(), sequence,
                          [](std::uint64_t wanted, const Entry& entry) { return wanted < entry.sequence(); });
}

InputBuffer::Entries::const_iterator InputBuffer::find(std::uint64_t sequence) const {
  const auto at = from(sequence);
  return at != samples_.end() && at->sequence() == sequence ? at : samples_.end();
}

void InputBuffer::keep(const Sample& sample, bool valid) {
  const std::uint64_t sequence = sample.header->sequence_number;
  const auto at = samples_.begin() + (from(sequence) - samples_.cbegin());
  if (at != samples_.end() && at->sequence() == sequence) *at = {sample, valid};
  else samples_.insert(at, {sample, valid});
}

std::uint64_t InputBuffer::newest_valid(std::uint64_t target) const {
  for (auto at = after(target); at != samples_.begin();) {
    --at;
    if (at->valid) return at->sequence();
  }
  return 0;
}

bool InputBuffer::complete(const msg::Tick& tick) const {
  const std::size_t topic = slot_.topic->id;
  const std::uint64_t target = tick.visible[topic];
  if (target == 0 || tick.realtime) return true;
  const auto newest = find(target);
  if (newest == samples_.end() || newest->sample.header->incarnation != tick.incarnations[topic]) return false;
  // After a restart the previous valid sample, which stays in force, may still be on its way.
  if (!newest->valid && last_valid_ > 0 && newest_valid(target) == 0) return false;
  if (!slot_.events) return true;
  for (std::uint64_t sequence = consumed_ + 1; sequence < target; ++sequence) {
    if (find(sequence) == samples_.end()) return false;
  }
  return true;
}

bool InputBuffer::complete_again() const { return last_valid_ == 0 || from(last_valid_) != samples_.end(); }

void InputBuffer::present_again(std::int64_t tick) {
  slot_.now_tick = tick;
  slot_.fresh.clear();
  const auto newest = from(last_valid_);
  if (last_valid_ > 0 && newest != samples_.end()) slot_.latest = newest->sample;
}

void InputBuffer::present(const msg::Tick& tick) {
  const std::uint64_t target = tick.realtime ? this->newest() : tick.visible[slot_.topic->id];
  slot_.now_tick = tick.index;
  slot_.fresh.clear();
  const std::uint64_t newest = newest_valid(target);
  if (newest > 0) slot_.latest = find(newest)->sample;
  if (slot_.events) {
    for (auto at = after(consumed_); at != samples_.end() && at->sequence() <= target; ++at) {
      if (at->valid) slot_.fresh.push_back(at->sample);
    }
  } else if (newest > consumed_) {
    slot_.fresh.push_back(slot_.latest);
  }
  consumed_ = std::max(consumed_, target);
  last_valid_ = std::max(last_valid_, newest);
  samples_.erase(samples_.begin(), from(last_valid_));
}

}  // namespace constrictor
