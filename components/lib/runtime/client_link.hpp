// Reads the topic `request/v2` into the latch of clients' requests, and tracks which clients are alive.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "component/client_requests.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// Topic on which clients send requests.
inline constexpr const char* kRequestTopic = barrier_topics::kRequest;

/// Tracks which writers that were matched with the reader of `request/v2` are alive. DDS reports the end of a source
/// only if the reader has taken a sample of it. A restarted process has none of the samples of its predecessor, so it
/// must track the writers themselves.
class WriterTracker {
 public:
  /// `grace`: time after the start in which a writer may still be discovered.
  explicit WriterTracker(std::chrono::milliseconds grace) : grace_(grace) {}
  /// Records that a writer is now alive or dead. May be called from any thread.
  void note(dds_instance_handle_t writer, bool alive);
  /// Applies the changes that other threads have recorded with note().
  void catch_up(dds_entity_t reader);
  /// GUID of the writer; all zeros if the writer no longer exists.
  [[nodiscard]] WriterId id_of(dds_entity_t reader, dds_instance_handle_t writer);
  /// True if the writer is alive, or if it may still be discovered.
  [[nodiscard]] bool lives(dds_entity_t reader, const WriterId& writer);

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  std::chrono::milliseconds grace_;
  std::mutex mutex_;
  std::vector<std::pair<dds_instance_handle_t, bool>> news_;
  std::map<dds_instance_handle_t, WriterId> ids_;
  std::map<WriterId, bool> alive_;
};

/// Time after the start of `input`'s process in which the writer of a known source may be discovered. It is wall time,
/// as leases are; deaths are latched at a tick, as requests are.
inline constexpr std::chrono::milliseconds kWriterGrace{3000};

/// Reads `request/v2`: reliable, keep-all, volatile, so that requests from before the start are not obeyed. It matches
/// writers of any liveliness and lease: DDS reports when the last writer of a source ends, is killed, or misses its
/// lease.
class ClientLink {
 public:
  /// Returns why a client may not send this request, in words for people; empty if it may. It is not asked about
  /// emergency stops.
  using Admit = std::function<std::string(const msg::Request&)>;

  /// `token`: requests without it cost memory, one source each, only up to a limit in the life of this object; empty:
  /// there is no such limit.
  ClientLink(dds_entity_t participant, std::uint16_t robot_id, Admit admit = {},
             std::chrono::milliseconds grace = kWriterGrace, std::string token = {});
  /// Lets `requests` ask this object which writers are alive. This object must outlive the last such call.
  void track_writers_for(ClientRequests& requests) const;
  /// Moves what has arrived to `requests`. Requests to another robot are ignored. `refused(reason)` is called for a
  /// request that violates its IDL.
  void take(ClientRequests& requests, const std::function<void(const std::string&)>& refused) const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  std::uint16_t robot_id_;
  Admit admit_;
  struct Gate {
    std::string token;
    std::atomic<int> strange_requests{0};
    std::atomic<int> strange_stops{0};
    [[nodiscard]] bool passes(const msg::Request& request);
  };
  std::unique_ptr<Gate> gate_;              // outlives the reader, which calls it in threads of DDS
  std::unique_ptr<WriterTracker> tracker_;  // outlives the reader, whose listener calls it
  dds::Entity reader_;
};

}  // namespace constrictor
