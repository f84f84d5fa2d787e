// Writes recorded messages to an MCAP file. In lock-step, every message is in the open chunk when write() returns. At
// real-time pace a thread writes them, so that nothing waits for the disk; what it cannot write in time is counted.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>

#include "recording/mcap_writer.hpp"

namespace constrictor {

/// A channel of the recording. Must outlive the sink.
struct RecordedChannel {
  std::string topic;
  std::string schema_name;  ///< empty: no schema
  std::string schema;
  mcap::Texts metadata;
};

/// One message. `log_time_ns`: simulated time.
struct RecordedMessage {
  const RecordedChannel* channel = nullptr;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::string_view cdr;  ///< need not outlive the call that takes the message
};

class RecordingSink {
 public:
  /// A chunk is closed when its first message is this old (wall time): so much is lost if the process is killed.
  static constexpr std::chrono::milliseconds kChunkTime{250};
  /// [byte] of messages that wait for the thread; further ones are dropped.
  static constexpr std::size_t kMostWaiting = 64 << 20;

  /// `threaded`: the writer works in a thread of its own.
  RecordingSink(std::unique_ptr<mcap::Writer> writer, bool threaded);
  ~RecordingSink();
  RecordingSink(const RecordingSink&) = delete;
  RecordingSink& operator=(const RecordingSink&) = delete;

  void write(const RecordedMessage& message);
  /// Closes the chunk if it is old enough. To be called at least every 100 ms.
  void poll();
  /// Why nothing more is written; empty if all is well.
  [[nodiscard]] std::string failure() const;
  /// Messages that were dropped because the thread was too slow, by topic.
  [[nodiscard]] std::map<std::string, std::uint64_t> gaps() const;
  /// The writer; only without a thread.
  [[nodiscard]] const mcap::Writer& writer() const { return *writer_; }
  /// Writes what waits, `last` and the summary. Returns the error; empty if there was none.
  std::string finish(std::vector<mcap::Metadata> last);

 private:
  /// A message with the memory of its CDR, for the thread.
  struct Waiting {
    RecordedMessage message;
    std::string cdr;
  };
  void put(const RecordedMessage& message);
  void close_old_chunk();
  void loop();

  std::unique_ptr<mcap::Writer> writer_;
  std::unordered_map<const RecordedChannel*, std::uint16_t> ids_;
  std::optional<std::chrono::steady_clock::time_point> chunk_began_;
  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable wake_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::map<std::string, std::uint64_t> gaps_;
  std::string failure_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace constrictor
