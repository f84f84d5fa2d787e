#include "runtime/outside_requests.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace constrictor {

void OutsideRequests::add(const msg::Request& request) {
  const std::lock_guard lock(mutex_);
  const bool stop = request.kind == msg::kRequestEmergencyStop;
  if (items_.size() >= capacity_ && (!stop || std::exchange(stop_kept_, true))) {
    ++dropped_;
    return;
  }
  items_.push_back({request.source, false, request});
}

void OutsideRequests::add_death(const std::string& source) {
  const std::lock_guard lock(mutex_);
  // One death of a source says it all: deaths between two ticks are bounded by the sources.
  const auto same = [&](const OutsideItem& item) { return item.died && item.source == source; };
  if (std::none_of(items_.begin(), items_.end(), same)) items_.push_back({source, true, {}});
}

std::vector<OutsideItem> OutsideRequests::latch() {
  std::vector<OutsideItem> items;
  {
    const std::lock_guard lock(mutex_);
    items.swap(items_);
    stop_kept_ = false;
  }
  const auto order = [](const OutsideItem& item) {
    return std::make_tuple(item.died, -int{item.request.level}, std::cref(item.source), item.request.header.sequence_number);
  };
  std::stable_sort(items.begin(), items.end(), [&](const OutsideItem& a, const OutsideItem& b) { return order(a) < order(b); });
  return items;
}

std::uint64_t OutsideRequests::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace constrictor
