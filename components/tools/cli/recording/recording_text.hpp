// The summary of a recording as one sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "recording/recording_summary.hpp"

namespace constrictor::cli {

inline constexpr int kMissing = 1;  ///< exit status: the recording is not complete

/// "84123 messages of 40 topics".
[[nodiscard]] std::string amount_text(std::uint64_t messages, std::size_t topics);

/// "84123 messages of 40 topics, 12.3 MB, 120.0 s; nothing is missing".
[[nodiscard]] std::string describe_recording(const RecordingSummary& summary);

/// The content of the recording in a report directory, for report.json; "text" is a line for people. Null: there is
/// none.
[[nodiscard]] nlohmann::ordered_json recording_report(const std::filesystem::path& report_dir);

}  // namespace constrictor::cli
