// `constrictor info` and `constrictor recover`: what a recording contains, and the end of one whose writer was killed.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/recording/recorded_messages.hpp"
#include "cli/recording/recording_text.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "constrictor/json.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/mcap_writer.hpp"
#include "recording/recording_summary.hpp"
#include "recording/recovery.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::string file;
  bool json = false;
  bool events = false;
};

/// Log times of a run are simulated; others are wall time.
std::string time_text(const RecordingSummary& summary, std::uint64_t time_ns) {
  const auto kind = summary.recording.find("log_time");
  if (kind != summary.recording.end() && kind->second == "simulated")
    return fmt::format("{:.2f} s", static_cast<double>(time_ns) * 1e-9);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(time_ns / 1'000'000'000)));
}

Json json_of(const RecordingSummary& summary) {
  Json json = {
      {"file_bytes", summary.file_bytes}, {"chunks", summary.chunks},
      {"messages", summary.messages},     {"duration_s", static_cast<double>(summary.end_ns - summary.start_ns) * 1e-9},
      {"incomplete", summary.incomplete}, {"proven_complete", summary.proven && summary.missing() == 0},
      {"missing", summary.missing()},     {"recording", summary.recording},
      {"dropped", summary.dropped},       {"recovered", summary.recovered},
      {"mission", summary.mission}};
  for (const char* list : {"epochs", "topics", "events", "attachments"}) json[list] = Json::array();
  for (const auto& epoch : summary.epochs) {
    json["epochs"].push_back({{"run_id", epoch.run_id},
                              {"epoch", epoch.epoch},
                              {"seed", epoch.seed},
                              {"first_tick", epoch.first_tick},
                              {"last_tick", epoch.last_tick},
                              {"ticks", epoch.ticks},
                              {"end_s", epoch.end_s}});
  }
  for (const auto& topic : summary.topics) {
    json["topics"].push_back({{"topic", topic.name},
                              {"type", topic.type},
                              {"no_schema", topic.no_schema},
                              {"messages", topic.messages},
                              {"bytes", topic.bytes},
                              {"history", topic.history},
                              {"rate_hz", topic.rate_hz()},
                              {"missing", topic.missing}});
  }
  for (const auto& event : summary.events)
    json["events"].push_back({{"epoch", event.epoch}, {"time_s", event.time_s}, {"text", event.text}});
  for (const auto& [name, bytes] : summary.attachments)
    json["attachments"].push_back({{"name", name}, {"bytes", bytes}});
  return json;
}

void print_topics(const RecordingSummary& summary) {
  fmt::print("\n{:<28} {:>9} {:>9} {:>10} {:>8}  {}\n", "topic", "messages", "rate [Hz]", "size [kB]", "missing",
             "type");
  for (const auto& topic : summary.topics) {
    const std::string type = topic.type.empty() ? "?" : topic.type;
    const double rate_hz = topic.rate_hz();
    fmt::print("{:<28} {:>9} {:>9} {:>10.1f} {:>8}  {}{}\n", topic.name, topic.messages,
               rate_hz > 0 ? fmt::format("{:.2f}", rate_hz) : "-", static_cast<double>(topic.bytes) * 1e-3,
               topic.missing, type, topic.no_schema.empty() ? "" : " (bytes without schema: " + topic.no_schema + ")");
  }
}

int show_info(const InfoOptions& options) {
  const std::string file = recording_or_throw(options.file).string();
  const RecordingSummary summary = summarise_recording(file);
  const bool whole = summary.missing() == 0 && summary.incomplete.empty() && summary.dropped.empty();
  if (options.json) {
    fmt::print("{}\n", json_text(json_of(summary), 2));
    return whole ? exit_status::kOk : kMissing;
  }
  fmt::print("{}: {}\n", file, describe_recording(summary));
  fmt::print("log time {} to {}\n", time_text(summary, summary.start_ns), time_text(summary, summary.end_ns));
  for (const auto& [name, value] : summary.recording) {
    if (!value.empty()) fmt::print("  {}: {}\n", name, value);
  }
  for (const auto& epoch : summary.epochs) {
    fmt::print("run {:x}, epoch {}: seed {}, ticks {} to {} ({}), {:.1f} s simulated\n", epoch.run_id, epoch.epoch,
               epoch.seed, epoch.first_tick, epoch.last_tick, epoch.ticks, epoch.end_s);
  }
  if (!summary.mission.empty()) fmt::print("mission {}\n", summary.mission);
  print_topics(summary);
  if (!summary.attachments.empty()) fmt::print("\nattachments:\n");
  for (const auto& [name, bytes] : summary.attachments) fmt::print("  {} ({})\n", name, counted(bytes, "byte"));
  if (!summary.events.empty()) fmt::print("\nevents:\n");
  for (const auto& event : summary.events) {
    fmt::print("  {:>8.2f} s  {}{}\n", event.time_s, event.text,
               summary.epochs.size() > 1 ? fmt::format("  (epoch {})", event.epoch) : "");
  }
  return whole ? exit_status::kOk : kMissing;
}

/// Keeps the damaged recording unchanged, under another name: the user may need the parts that the copy leaves out.
int recover_damaged(const fs::path& file) {
  fs::path kept = file.string() + ".damaged";
  for (int number = 2; fs::exists(kept); ++number) kept = fmt::format("{}.damaged-{}", file.string(), number);
  NewFile copy = NewFile::of_this_process(file);
  const mcap::Recovered recovered = mcap::copy_undamaged(file, copy.part());
  fs::rename(file, kept);
  copy.complete();
  fmt::print("{}: {} in {}, {} in {} left out ({}); the damaged file is {}\n", file.string(),
             counted(recovered.messages, "message"), counted(recovered.chunks, "chunk"),
             counted(recovered.left_out_bytes, "byte"), counted(recovered.places, "place"), recovered.why,
             kept.string());
  return exit_status::kOk;
}

int recover(const std::string& name) {
  const std::string file = recording_or_throw(name).string();
  mcap::Reader reader(file);
  try {
    reader.read();
  } catch (const mcap::Error&) {
    {
      const mcap::File changed(file, mcap::File::Mode::kChange);  // refuses a file that another process is writing
    }
    return recover_damaged(file);
  }
  const std::string why = reader.incomplete();
  if (why.empty()) {
    fmt::print("{}: is complete; nothing to recover\n", file);
    return exit_status::kOk;
  }
  const std::uint64_t before = fs::file_size(file);
  const std::uint64_t kept = reader.data_end();
  mcap::Writer writer(reader);
  writer.finish({{"recovered", {{"cut_bytes", std::to_string(before - std::min(before, kept))}, {"reason", why}}}});
  fmt::print("{}: {} in {}, {} cut ({})\n", file, counted(writer.contents().statistics.message_count, "message"),
             counted(writer.contents().chunks.size(), "chunk"), counted(before - std::min(before, kept), "byte"), why);
  return exit_status::kOk;
}

}  // namespace

void add_recording_files(CLI::App& app, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  auto* info_app = add_subcommand(app, "info", "describe a recording: topics, rates, events, mission, what is missing",
                                  action, options, show_info);
  info_app->add_option("FILE", options->file, kFileMeaning)->required()->check(existing_path());
  info_app->add_flag("--json", options->json, "print JSON instead of text, for scripts");
  info_app->footer(help_footer(
      "Reads the whole file and checks everything in it. In the recording of a whole run in lock-step, the ticks name\n"
      "the number of messages of each topic, so that `info` knows whether one is missing. Otherwise it counts the\n"
      "numbers of messages that were left out. A rate does not count messages of the time before the recording,\n"
      "which writers keep for late readers; - means that it is not known.",
      {"constrictor info runs/NAME/run.mcap", "constrictor info run.mcap --json"},
      "0 complete; 1 messages are missing, or the file was not finished; 64 wrong usage; 70 damaged, or no MCAP file",
      "none"));

  auto file = std::make_shared<std::string>();
  auto* recover_app = add_subcommand(app, "recover", "finish a recording whose writer was killed, or that is damaged",
                                     action, file, recover);
  recover_app->add_option("FILE", *file, kFileMeaning)->required()->check(existing_path());
  recover_app->footer(help_footer(
      "If its writer was killed, the file is finished: everything up to the last complete chunk, with indexes and\n"
      "summary. If it is damaged, everything that can be read goes into a new file of its name, and the damaged one "
      "is\n"
      "kept as FILE.damaged. A recording that a process is still writing is refused.",
      {"constrictor recover run.mcap"}, "0 the file is complete now; 64 wrong usage; 70 no MCAP file", "none"));
}

}  // namespace constrictor::cli
