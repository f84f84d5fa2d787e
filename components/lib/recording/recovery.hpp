// Copies the readable part of a damaged recording into a complete recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace constrictor::mcap {

struct Recovered {
  std::uint64_t messages = 0;  ///< that are kept
  std::uint64_t chunks = 0;
  std::uint64_t left_out_bytes = 0;  ///< of the damaged file
  std::uint64_t places = 0;          ///< at which something is left out
  std::string why;                   ///< reason at the first of these places
};

/// Writes what can be read of `damaged` into the new file `copy`: messages, attachments and metadata. Its metadata
/// `recovered` say what was left out. Throws Error; DiskFull if there is no space for the copy.
Recovered copy_undamaged(const std::filesystem::path& damaged, const std::filesystem::path& copy);

}  // namespace constrictor::mcap
