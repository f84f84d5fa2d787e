// The table of topics names `physics` as the writer of what the plant writes. In a run with another plant, that one
// writes these topics.
#pragma once

#include <string>

#include "constrictor/topics.hpp"

namespace constrictor {

[[nodiscard]] inline bool is_written_by_plant(const TopicInfo& topic) {
  return topic.writer == topics::kJointState.writer;
}

/// The member that writes a topic in a run whose plant is `plant`.
[[nodiscard]] inline std::string writer_in_run(const TopicInfo& topic, const std::string& plant) {
  return is_written_by_plant(topic) ? plant : std::string(topic.writer);
}

}  // namespace constrictor
