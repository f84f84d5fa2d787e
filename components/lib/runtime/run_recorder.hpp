// `run --record`: the recording of a whole run, in the plant's process. It receives every message of the members by the
// same way as the checkpoints do, so it misses nothing in lock-step, where the run waits for it. Topics that no tick
// counts, also those of other programs, arrive over DDS.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "barrier/protocol.hpp"
#include "component/ports.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/host_context.hpp"
#include "runtime/recording_sink.hpp"

namespace constrictor {

class DomainTap;

/// A place in a recording, at which the successor of a process that died continues.
struct RecordingPosition {
  bool recording = false;      ///< false: there is no recording, or it has ended
  bool exact = false;          ///< false: at real-time pace, where the successor continues after the last chunk
  std::uint64_t chunks = 0;    ///< that are in the file
  std::uint64_t open = 0;      ///< [byte] of the open chunk, not compressed
  std::int64_t base_ns = 0;    ///< log time of the epoch's tick 0
  std::int64_t newest_ns = 0;  ///< newest log time
  std::int64_t period_ns = 0;  ///< of the ticks
  template <class Archive>
  void serialize(Archive& archive) {
    archive(recording, exact, chunks, open, base_ns, newest_ns, period_ns);
  }
};

class RunRecorder {
 public:
  /// Begins the file run.mcap in the run's output folder; `from`: continues it. Throws mcap::Error.
  explicit RunRecorder(const HostContext& context, std::optional<RecordingPosition> from = {});
  ~RunRecorder();

  void add(const msg::EpochStart& start);
  void add(const msg::Tick& tick);
  void add(const TickDone& done);
  void add(const TopicInfo& topic, const Sample& sample);
  /// A message of a member topic as canonical bytes.
  void add(std::uint8_t topic, const std::string& canonical);

  /// Takes what arrived over DDS, and closes a chunk that is old enough. To be called at least every 100 ms.
  void poll();
  /// The position from which a successor continues, after everything before it was stored.
  [[nodiscard]] RecordingPosition position();
  /// Ends the file.
  void finish();

 private:
  [[nodiscard]] std::unique_ptr<mcap::Writer> begin() const;
  [[nodiscard]] std::unique_ptr<mcap::Writer> resume(const RecordingPosition& from);
  void make_channels();
  template <class T>
  void write(const RecordedChannel& channel, const T& message, std::uint32_t sequence, std::int64_t time_ns);
  void write(const RecordedMessage& message);
  void store_open_chunk();
  void give_up(const std::string& reason);

  const HostContext& context_;
  const std::filesystem::path file_;
  std::array<RecordedChannel, topics::kCount> members_;
  std::array<const MessageCodec*, topics::kCount> codecs_{};
  // Memory for one message, used again and again: an image that is freed gives its pages back to the kernel, which
  // clears them each time.
  std::string canonical_;
  std::string cdr_;
  RecordedChannel tick_;
  RecordedChannel tick_done_;
  RecordedChannel epoch_start_;
  std::set<std::pair<std::string, std::uint64_t>> known_;  ///< topic and publish time of what arrived over DDS before
  std::int64_t base_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t tick_index_ = -1;
  std::unique_ptr<RecordingSink> sink_;    ///< null: the recording has ended
  std::unique_ptr<mcap::File> unwritten_;  ///< the open chunk; null: no successor can continue
  std::uint64_t unwritten_chunk_ = 0;      ///< number of the chunk that it holds
  std::uint64_t unwritten_size_ = 0;       ///< [byte] of it that are stored
  std::unique_ptr<DomainTap> tap_;
};

}  // namespace constrictor
