#include "client/components.hpp"

#include "client/polling.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

std::map<std::string, ComponentMessages> read(std::int32_t participant, std::chrono::milliseconds bound,
                                              bool wait_for_first) {
  const auto hellos = dds::Reader<msg::Hello>::member(participant, barrier_topics::kHello);
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(participant, barrier_topics::kStatus);
  std::map<std::string, ComponentMessages> found;
  const auto poll = [&] {
    bool any = false;
    hellos.take([&](const msg::Hello& hello) {
      auto& component = found[hello.component];
      if (!component.hello || component.hello->incarnation <= hello.incarnation) component.hello = hello;
      any = true;
    });
    statuses.take([&](const msg::ComponentStatus& status) {
      auto& component = found[status.component];
      any = any || !component.status;
      if (!component.status || component.status->incarnation <= status.incarnation) component.status = status;
    });
    return any;
  };
  wait_until_quiet(kQuiet, bound, poll, [&] { return !wait_for_first || !found.empty(); });
  return found;
}

}  // namespace

std::map<std::string, ComponentMessages> read_component_messages(std::int32_t participant,
                                                                 std::chrono::milliseconds bound) {
  return read(participant, bound, false);
}

std::map<std::string, msg::ComponentStatus> read_components(std::int32_t participant, std::chrono::milliseconds bound) {
  std::map<std::string, msg::ComponentStatus> components;
  for (const auto& [name, messages] : read(participant, bound, true)) {
    if (messages.status) components.emplace(name, *messages.status);
  }
  return components;
}

}  // namespace constrictor
