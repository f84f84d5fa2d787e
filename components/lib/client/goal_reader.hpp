// Reads the topics that a GoalTracker needs.
#pragma once

#include "client/goal_tracker.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// Follows the goals of a run over DDS.
class GoalReader {
 public:
  /// `participant` must outlive this object.
  explicit GoalReader(dds_entity_t participant);
  /// Takes everything that has arrived.
  void poll();
  [[nodiscard]] const GoalTracker& goals() const { return tracker_; }

 private:
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::TaskStatus> status_;
  dds::Reader<msg::TaskEvent> event_;
  GoalTracker tracker_;
};

}  // namespace constrictor
