#include "input/outside_requests.hpp"

#include <algorithm>
#include <tuple>

namespace constrictor {

void OutsideRequests::add(const msg::Request& request) {
  const std::lock_guard lock(mutex_);
  if (items_.size() >= capacity_ && request.kind != msg::kRequestEmergencyStop) {
    ++dropped_;
    return;
  }
  items_.push_back({request.source, false, request});
}

void OutsideRequests::add_death(const std::string& source) {
  const std::lock_guard lock(mutex_);
  items_.push_back({source, true, {}});
}

std::vector<OutsideItem> OutsideRequests::latch() {
  std::vector<OutsideItem> items;
  {
    const std::lock_guard lock(mutex_);
    items.swap(items_);
  }
  const auto order = [](const OutsideItem& item) {
    return std::make_tuple(std::cref(item.source), item.died, item.request.header.sequence_number);
  };
  std::stable_sort(items.begin(), items.end(), [&](const OutsideItem& a, const OutsideItem& b) { return order(a) < order(b); });
  return items;
}

std::uint64_t OutsideRequests::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace constrictor
