// Reads all topics of a domain that a caller wants, of any type: for recorders and viewers.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cyclone/raw_reader.hpp"
#include "cyclone/type_tree.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor::dds {

class TopicTap {
 public:
  struct Topic {
    std::string name;
    std::string type;  ///< DDS name, "constrictor::msg::JointState"
    bool keyed = false;
    Ros2Schema schema;  ///< its name is empty if the type is not known or cannot be expressed
  };
  /// Decides by a topic's name.
  using Wanted = std::function<bool(const std::string&)>;

  /// `everything`: keeps all samples until they are taken, for recorders; else only the last 1,024 of each topic, for
  /// viewers.
  TopicTap(dds_entity_t participant, Wanted wanted, bool everything = true);
  /// Begins to read a topic that has no writer yet, so that it misses nothing of a writer that soon ends. The writers
  /// must be reliable. `transient_local`: they keep samples for late readers, too. Throws Error.
  void expect(const std::string& topic, const std::string& type, bool keyed, bool transient_local);
  /// Begins to read the topics that have got a writer since the last call. Fast if there is no new writer. A topic that
  /// this process may not read (in a secured run) is left out and noted in refused().
  void discover();
  /// Returns when samples have arrived, or after `bound`.
  void wait(std::chrono::milliseconds bound) const;
  /// Takes all samples that have arrived.
  void take(const std::function<void(const Topic&, const RawSample&)>& use) const;
  /// Samples that writers replaced before they arrived here, by topic; only topics with such samples.
  [[nodiscard]] std::map<std::string, std::uint64_t> lost() const;
  [[nodiscard]] const std::map<std::string, std::string>& refused() const { return refused_; }
  [[nodiscard]] std::vector<const Topic*> topics() const;

 private:
  struct Reading {
    Topic topic;
    RawQos qos;
    std::unique_ptr<RawReader> reader;
    std::uint64_t lost_before = 0;  ///< by readers that were replaced
  };
  void read(const Endpoint& writer);
  [[nodiscard]] Ros2Schema schema_of(const Endpoint& writer) const;

  dds_entity_t participant_;
  Wanted wanted_;
  bool everything_;
  Discovery discovery_;
  WaitSet wait_set_;
  std::map<std::string, Reading> readings_;  ///< by topic, type and key
  std::map<std::string, std::string> refused_;
};

}  // namespace constrictor::dds
