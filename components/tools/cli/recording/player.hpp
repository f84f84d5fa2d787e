// Publishes the messages of a recording in a DDS domain, in their time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace constrictor::cli {

struct PlayOptions {
  std::filesystem::path file;
  std::optional<double> speed;      ///< times the recorded speed; empty: as fast as possible
  double from_s = 0.0;              ///< [s] after the first message
  std::vector<std::string> topics;  ///< patterns; empty: all but commands
  bool paused = false;
  bool stay = false;  ///< after the last message, until the user ends it
  std::optional<std::uint32_t> domain;
};

/// Returns the exit status. Throws mcap::Error, dds::Error, or CommandError if the domain has a run.
int play_recording(const PlayOptions& options);

}  // namespace constrictor::cli
