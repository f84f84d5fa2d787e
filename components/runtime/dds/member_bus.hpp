// The member topics of one process on DDS: a writer for each topic its components write, a reader for each that a component
// elsewhere writes and one here reads.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "runtime/barrier/topic_ops.hpp"
#include "runtime/dds/endpoint.hpp"

namespace constrictor::dds {

/// An endpoint here that has not met its counterpart.
struct Unmatched {
  const TopicInfo* topic = nullptr;
  bool reader = false;      ///< which end is here
  std::string counterpart;  ///< the component that has the other
  [[nodiscard]] bool empty() const { return topic == nullptr; }
};

class MemberBus {
 public:
  /// `reads` and `writes` are bit masks over topic ids; `identity` names the components here ("a,b").
  MemberBus(dds_entity_t participant, std::uint64_t reads, std::uint64_t writes, const std::string& identity);

  void write(const TopicInfo& topic, const Sample& sample) const;
  /// Readers with their topic ids, for a wait set.
  [[nodiscard]] std::vector<std::pair<std::size_t, dds_entity_t>> readers() const;
  /// Takes what has arrived on one topic.
  void take(std::size_t topic_id, const std::function<void(const Sample&)>& use) const;

  /// First endpoint here whose counterpart is missing; empty if all have met. `readers_of[topic]`: roster members elsewhere that
  /// read the topic.
  [[nodiscard]] Unmatched unmatched(const std::map<std::size_t, std::vector<std::string>>& readers_of) const;
  /// For people: both sides with their QoS, that of the counterpart as discovery tells it, or that it is not there.
  [[nodiscard]] std::string explain(const Unmatched& missing) const;

 private:
  dds_entity_t participant_;
  std::array<Entity, topics::kCount> readers_;
  std::array<Entity, topics::kCount> writers_;
};

}  // namespace constrictor::dds
