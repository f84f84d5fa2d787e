// Typed DDS readers and writers with the two qualities of service of this project: member and observer.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "constrictor/descriptors.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// Reliable, transient-local, keep-last: the writer keeps its last `depth` samples for late and restarted readers, and
/// write() never blocks. Throws Error.
dds_entity_t create_writer(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                           int depth, const std::string& user_data);
/// Reliable, transient-local, keep-all: the reader receives everything that a writer keeps. Throws Error.
dds_entity_t create_member_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, const std::string& user_data);
/// Best effort, volatile, keep-last `depth`: the reader never delays a writer. Throws Error.
dds_entity_t create_observer_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                    const std::string& topic, int depth);

/// Takes all samples that have arrived and calls `use(const void* message)` for each valid one. The loan is returned
/// also if `use` throws.
template <class Use>
void take_all(dds_entity_t reader, Use&& use) {
  // Nearly always one sample has arrived. After each take Cyclone clears as many structs as the largest batch that was
  // asked for: with batches of 32, that was up to 0.4 MB for each sample of contacts.
  constexpr std::size_t kBatch = 2;
  for (;;) {
    std::array<void*, kBatch> messages{};
    std::array<dds_sample_info_t, kBatch> infos{};
    const int count = check(dds_take(reader, messages.data(), infos.data(), kBatch, kBatch), "dds_take");
    if (count == 0) return;
    struct Loan {
      dds_entity_t reader;
      void** messages;
      int count;
      ~Loan() { dds_return_loan(reader, messages, count); }
    } const loan{reader, messages.data(), count};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) use(static_cast<const void*>(messages[i]));
    }
    if (count < static_cast<int>(kBatch)) return;
  }
}

template <class T>
class Writer {
 public:
  Writer() = default;
  Writer(dds_entity_t participant, const std::string& topic, int depth, const std::string& user_data = {})
      : entity_(create_writer(participant, descriptor<T>(), topic, depth, user_data), "dds_create_writer") {}
  /// A writer of a barrier or client topic, with the depth of the table.
  Writer(dds_entity_t participant, const UncountedTopic<T>& topic) : Writer(participant, topic.name, topic.depth) {}
  void write(const T& message) const { check(dds_write(entity_.get(), &message), "dds_write"); }
  /// Number of readers that it has matched.
  [[nodiscard]] int readers() const {
    return check(dds_get_matched_subscriptions(entity_.get(), nullptr, 0), "dds_get_matched_subscriptions");
  }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  Entity entity_;
};

template <class T>
class Reader {
 public:
  Reader() = default;
  static Reader member(dds_entity_t participant, const std::string& topic, const std::string& user_data = {}) {
    return Reader(create_member_reader(participant, descriptor<T>(), topic, user_data));
  }
  static Reader observer(dds_entity_t participant, const std::string& topic, int depth = 1) {
    return Reader(create_observer_reader(participant, descriptor<T>(), topic, depth));
  }
  template <class Use>
  void take(Use&& use) const {
    take_all(entity_.get(), [&](const void* message) { use(*static_cast<const T*>(message)); });
  }
  /// Number of living writers that it has matched.
  [[nodiscard]] int writers() const {
    return check(dds_get_matched_publications(entity_.get(), nullptr, 0), "dds_get_matched_publications");
  }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  explicit Reader(dds_entity_t handle) : entity_(handle, "dds_create_reader") {}
  Entity entity_;
};

using constrictor::set_text;

/// User data of every endpoint that matches this reader or writer.
std::vector<std::string> matched_user_data(dds_entity_t endpoint, bool is_writer);

}  // namespace constrictor::dds
