// The messages of members in a recording, as `constrictor diff` compares them: those of the last epoch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/hash_log.hpp"

namespace constrictor::cli {

/// The recording of a run that is given by its recording or its report directory; empty if it has none.
[[nodiscard]] std::filesystem::path recording_of(const std::filesystem::path& run);

/// The same; throws UsageError if there is none.
[[nodiscard]] std::filesystem::path recording_or_throw(const std::string& name);

/// The help text of such an argument.
inline constexpr const char* kFileMeaning = "recording (MCAP), or the report directory of a run with --record";

/// Whether the recording has the pixels of images.
[[nodiscard]] bool has_images(const std::filesystem::path& recording);

/// The hashes of all messages, ordered as HashLog::read() does, without the messages themselves. `images`: also of
/// images. Throws mcap::Error.
[[nodiscard]] std::vector<HashLog::Entry> recorded_hashes(const std::filesystem::path& recording, bool images);

/// One message as canonical bytes, with a neutral header and robot id 0; nothing if the recording does not have it.
/// Throws mcap::Error.
[[nodiscard]] std::optional<std::string> recorded_message(const std::filesystem::path& recording, std::uint8_t topic,
                                                          std::uint64_t sequence_number);

}  // namespace constrictor::cli
