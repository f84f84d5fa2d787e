// The member topics of one process on DDS: a writer for each topic that its components write, and a reader for each
// topic that they read and that a component of another process writes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "barrier/topic_ops.hpp"
#include "component/topic_set.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// An endpoint of this process that has not met its counterpart.
struct Unmatched {
  const TopicInfo* topic = nullptr;
  bool reader = false;      ///< whether the endpoint of this process is the reader
  std::string counterpart;  ///< the component that has the other endpoint
  [[nodiscard]] bool empty() const { return topic == nullptr; }
};

class MemberBus {
 public:
  /// `identity`: names of the components of this process ("a,b"), the user data of its endpoints. Throws dds::Error.
  /// `book`: notes the writers that are matched with the readers, and must outlive them; null: none.
  MemberBus(dds_entity_t participant, TopicSet reads, TopicSet writes, const std::string& identity,
            dds::WriterBook* book = nullptr);

  void write(const TopicInfo& topic, const Sample& sample) const;
  /// Readers with their topic ids, to wait for their samples.
  [[nodiscard]] std::vector<std::pair<std::size_t, dds_entity_t>> readers() const;
  /// Takes all samples that have arrived on one topic: `use(sample, publication handle of its writer)`.
  void take(std::size_t topic_id, const std::function<void(const Sample&, dds_instance_handle_t)>& use) const;

  /// First endpoint of this process whose counterpart is missing; empty if all have met. `readers_of[topic]`: members
  /// in other processes that read the topic.
  /// `plant`: name of the plant in this run. `unwritten`: topics that the Hello of their component does not announce;
  /// their readers have no counterpart.
  [[nodiscard]] Unmatched unmatched(const std::map<std::size_t, std::vector<std::string>>& readers_of,
                                    TopicSet unwritten, const std::string& plant) const;
  /// Text for people: both endpoints with their QoS, or that the counterpart is not there.
  [[nodiscard]] std::string explain(const Unmatched& missing) const;

 private:
  dds_entity_t participant_;
  std::array<dds::Entity, topics::kCount> readers_;
  std::array<dds::Entity, topics::kCount> writers_;
};

}  // namespace constrictor
