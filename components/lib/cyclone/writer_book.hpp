// Which participant each remote writer belongs to, for readers that accept samples of announced participants only.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// The first 12 bytes of a GUID, as they are sent: they identify a participant.
using GuidPrefix = std::array<std::uint8_t, 12>;

/// The prefix of an entity of this process.
[[nodiscard]] GuidPrefix own_prefix(dds_entity_t entity);

/// Notes each writer at the time when a reader matches it, because the participant of a writer that is gone can no
/// longer be found, but its samples may still be waiting in the reader. Thread-safe.
class WriterBook {
 public:
  /// Writers beyond this number are not noted: strangers may create any number of them.
  static constexpr std::size_t kMost = 4096;
  static constexpr std::chrono::milliseconds kLongestWait{1000};

  WriterBook();
  /// Records the writers that this reader has matched and will match. This object must outlive the reader. The reader's
  /// status mask must not be changed afterwards: Cyclone's dds_set_status_mask() holds a lock of the reader while it
  /// waits until the listener has returned, and the listener needs this lock. Throws Error.
  void watch(dds_entity_t reader);
  /// The participant of the writer with this publication handle; empty if the writer was not noted. A sample can be
  /// taken before Cyclone has reported the match with its writer, which happens in another thread: an unknown writer is
  /// waited for, at most kLongestWait.
  [[nodiscard]] std::optional<GuidPrefix> participant_of(dds_instance_handle_t writer) const;
  /// True if a writer of this participant is matched at present.
  [[nodiscard]] bool lives(const GuidPrefix& participant) const;

 private:
  struct Entry {
    GuidPrefix participant{};
    std::set<dds_entity_t> readers;  ///< of this process that match it at present
  };
  void note(dds_entity_t reader, dds_instance_handle_t writer);
  void forget_some_dead();

  std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener_;
  mutable std::mutex mutex_;
  mutable std::condition_variable noted_;
  std::map<dds_instance_handle_t, Entry> writers_;
  std::size_t dead_ = 0;
};

}  // namespace constrictor::dds
