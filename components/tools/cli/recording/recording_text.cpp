#include "cli/recording/recording_text.hpp"

#include <fmt/format.h>

#include "configuration/counted.hpp"
#include "runtime/recording_options.hpp"

namespace constrictor::cli {

std::string amount_text(std::uint64_t messages, std::size_t topics) {
  return fmt::format("{} of {}", counted(messages, "message"), counted(topics, "topic"));
}

std::string describe_recording(const RecordingSummary& summary) {
  std::string text = fmt::format("{}, {:.1f} MB, {:.1f} s", amount_text(summary.messages, summary.topics.size()),
                                 static_cast<double>(summary.file_bytes) * 1e-6,
                                 static_cast<double>(summary.end_ns - summary.start_ns) * 1e-9);
  const auto entry = [](const mcap::Texts& texts, const char* name) {
    const auto found = texts.find(name);
    return found == texts.end() ? std::string("?") : found->second;
  };
  if (summary.missing() > 0) {
    text += fmt::format("; {} missing:",
                        summary.missing() == 1 ? "1 message is" : fmt::format("{} messages are", summary.missing()));
    for (const auto& topic : summary.topics) {
      if (topic.missing > 0) text += fmt::format(" {} of {},", topic.missing, topic.name);
    }
    text.pop_back();
  } else if (summary.proven) {
    text += "; nothing is missing: the file has every message that the ticks count";
  } else {
    text += "; no gap was found";
  }
  if (summary.dropped.contains("tick"))
    text += fmt::format("; the recording ends at tick {}: {}", entry(summary.dropped, "tick"),
                        entry(summary.dropped, "reason"));
  else if (!summary.dropped.empty())
    text += fmt::format("; the recording ends too early: {}", entry(summary.dropped, "reason"));
  if (!summary.recovered.empty())
    text += fmt::format("; it was recovered: {} bytes were left out ({})", entry(summary.recovered, "cut_bytes"),
                        entry(summary.recovered, "reason"));
  if (!summary.incomplete.empty()) text += fmt::format("; {} (`constrictor recover` finishes it)", summary.incomplete);
  return text;
}

nlohmann::ordered_json recording_report(const std::filesystem::path& report_dir) {
  const std::filesystem::path file = report_dir / kRecordingFile;
  if (!std::filesystem::exists(file)) return nullptr;
  try {
    const RecordingSummary summary = summarise_recording(file);
    return {
        {"file", kRecordingFile},           {"text", fmt::format("{}: {}", file.string(), describe_recording(summary))},
        {"messages", summary.messages},     {"bytes", summary.file_bytes},
        {"missing", summary.missing()},     {"proven_complete", summary.proven && summary.missing() == 0},
        {"incomplete", summary.incomplete}, {"dropped", summary.dropped}};
  } catch (const mcap::Error& error) {
    return {{"file", kRecordingFile}, {"text", error.what()}, {"incomplete", error.what()}};
  }
}

}  // namespace constrictor::cli
