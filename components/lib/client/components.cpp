#include "client/components.hpp"

#include <thread>

#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

std::map<std::string, msg::ComponentStatus> read_components(std::int32_t participant, std::chrono::milliseconds bound) {
  using Clock = std::chrono::steady_clock;
  const auto reader = dds::Reader<msg::ComponentStatus>::member(participant, barrier_topics::kStatus);
  std::map<std::string, msg::ComponentStatus> components;
  const auto start = Clock::now();
  auto changed = start;
  while (Clock::now() - start < bound &&
         (components.empty() || Clock::now() - changed < std::chrono::milliseconds(300))) {
    reader.take([&](const msg::ComponentStatus& status) {
      const auto [entry, added] = components.try_emplace(status.component, status);
      if (added) changed = Clock::now();
      else if (entry->second.incarnation <= status.incarnation) entry->second = status;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return components;
}

}  // namespace constrictor
