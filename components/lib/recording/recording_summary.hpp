// The content of a recording, and whether a message is missing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "recording/mcap_format.hpp"

namespace constrictor {

struct RecordedTopic {
  std::string name;
  std::string type;       ///< DDS name; empty: unknown
  std::string no_schema;  ///< why its messages have no schema; empty: they have one
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;     ///< of all messages
  std::uint64_t missing = 0;   ///< messages that were written but are not in the recording
  std::uint64_t history = 0;   ///< messages that were published before the recording began, and kept for late readers
  std::uint64_t first_ns = 0;  ///< log time of the first message that is not history
  std::uint64_t last_ns = 0;
  /// [Hz] mean rate without history, which arrives at once; 0: not known, because fewer than two messages arrived in
  /// at least 0.1 s.
  [[nodiscard]] double rate_hz() const;
};

struct RecordedEvent {
  std::uint32_t epoch = 0;
  double time_s = 0.0;  ///< simulated
  std::string text;     ///< "object grasped (green): ..."
};

struct RecordedEpoch {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::uint64_t seed = 0;        ///< 0: unknown
  std::int64_t first_tick = -1;  ///< -1: no tick
  std::int64_t last_tick = -1;
  std::uint64_t ticks = 0;
  double end_s = 0.0;  ///< [s] simulated time of the last tick
};

struct RecordingSummary {
  std::uint64_t file_bytes = 0;
  std::uint64_t chunks = 0;
  std::uint64_t messages = 0;
  std::string incomplete;  ///< why the file is not finished; empty: it is
  mcap::Texts recording;   ///< how it was made: kind, log_time, images ...; empty: by another program
  mcap::Texts dropped;     ///< tick and reason, if the recording ended before the run
  mcap::Texts recovered;   ///< metadata that `constrictor recover` wrote
  std::vector<std::pair<std::string, std::uint64_t>> attachments;  ///< name, bytes
  std::vector<RecordedTopic> topics;                               ///< by name
  std::vector<RecordedEpoch> epochs;
  std::vector<RecordedEvent> events;
  std::string mission;         ///< newest state of the mission, as text; empty: none
  std::uint64_t start_ns = 0;  ///< log times
  std::uint64_t end_ns = 0;

  [[nodiscard]] std::uint64_t missing() const;
  /// Whether the ticks in the file prove that nothing is missing: it is the recording of a whole run in lock-step.
  bool proven = false;
};

/// Reads a recording. Throws mcap::Error.
///
/// A topic of a member numbers its messages from 1 in each epoch, and each Tick names the number of messages that are
/// visible. A message is missing if its number was left out, or if the last Tick of its epoch counts it. In a recording
/// that began after the run, the first message of a topic is where counting begins.
[[nodiscard]] RecordingSummary summarise_recording(const std::filesystem::path& file);

}  // namespace constrictor
