#include "client/goal_reader.hpp"

#include <string>

#include "constrictor/topics.hpp"

namespace constrictor {

GoalReader::GoalReader(dds_entity_t participant)
    : authority_(dds::Reader<msg::Authority>::member(participant, std::string(topics::kAuthority.name))),
      status_(dds::Reader<msg::TaskStatus>::member(participant, std::string(topics::kTaskStatus.name))),
      event_(dds::Reader<msg::TaskEvent>::member(participant, std::string(topics::kTaskEvent.name))) {}

void GoalReader::poll() {
  const auto into = [this](const auto& message) { tracker_.take(message); };
  authority_.take(into);
  status_.take(into);
  event_.take(into);
}

}  // namespace constrictor
