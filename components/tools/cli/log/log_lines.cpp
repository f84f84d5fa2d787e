#include "cli/log/log_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "cli/log/log_files.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

/// Whether one of the names, which are joined by "," or "+", is `name`.
bool contains(const std::string& names, const std::string& name) {
  for (std::size_t at = 0; at <= names.size();) {
    const std::size_t end = std::min(names.find_first_of(",+", at), names.size());
    if (names.compare(at, end - at, name) == 0) return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

LogEntry entry_of(const msg::LogLine& line) {
  LogEntry entry;
  entry.process = constrictor::text_of(line.process);
  entry.host = constrictor::text_of(line.host);
  entry.pid = line.pid;
  entry.incarnation = line.incarnation;
  const std::string component = constrictor::text_of(line.component);
  const std::chrono::nanoseconds since(line.wall_time_ns);
  entry.record = {
      std::chrono::system_clock::time_point(std::chrono::duration_cast<std::chrono::system_clock::duration>(since)),
      line.level,
      component.empty() ? entry.process : component,
      line.run_id,
      line.epoch,
      line.tick,
      line.number,
      constrictor::text_of(line.message)};
  return entry;
}

bool LogFilter::accepts(const LogEntry& entry) const {
  const LogRecord& record = entry.record;
  if (record.level < least_level || record.tick < since_tick) return false;
  if (!text.empty() && record.text.find(text) == std::string::npos) return false;
  return components.empty() || std::any_of(components.begin(), components.end(),
                                           [&](const std::string& name) { return contains(record.subject, name); });
}

std::string text_of(const LogEntry& entry, const std::string& own_host) {
  if (entry.foreign) return fmt::format("{} | {}", entry.process, entry.record.text);
  LogRecord record = entry.record;
  if (!entry.host.empty() && entry.host != own_host) record.subject += "@" + entry.host;
  return log_text(record);
}

nlohmann::ordered_json to_json(const LogEntry& entry) {
  using std::chrono::nanoseconds;
  const LogRecord& record = entry.record;
  nlohmann::ordered_json json = {
      {"wall_time_ns", std::chrono::duration_cast<nanoseconds>(record.time.time_since_epoch()).count()},
      {"level", name_of(constants::kLog, record.level)},
      {"component", record.subject},
      {"process", entry.process}};
  const auto add = [&json](const char* key, const auto& value, bool known) {
    if (known) json[key] = value;
    else json[key] = nullptr;
  };
  add("host", entry.host, !entry.host.empty());
  add("pid", entry.pid, entry.pid > 0);
  add("incarnation", entry.incarnation, entry.incarnation > 0);
  add("epoch", record.epoch, record.epoch > 0);
  add("tick", record.tick, record.tick >= 0);
  add("number", record.number, record.number > 0);
  json["foreign"] = entry.foreign;
  json["message"] = record.text;
  return json;
}

std::vector<LogEntry> read_log_file(const fs::path& file, const LogFilter& filter) {
  std::vector<LogEntry> entries;
  LogEntry entry;
  entry.process = process_of_log(file);
  std::ifstream stream(file);
  std::chrono::system_clock::time_point newest{};
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    const auto record = read_log_text(line);
    entry.foreign = !record;
    if (record) {
      entry.record = *record;
      newest = record->time;
    } else {
      entry.record = {newest, msg::kLogWarning, entry.process, 0, entry.record.epoch, entry.record.tick, 0, line};
    }
    // Libraries and other programs write what they like, also for terminals.
    entry.record.text = printable(entry.record.text);
    entry.record.subject = printable(entry.record.subject);
    if (filter.accepts(entry)) entries.push_back(entry);
  }
  return entries;
}

std::vector<LogEntry> read_logs(const fs::path& folder, const LogFilter& filter) {
  const fs::path logs = fs::is_directory(folder / "logs") ? folder / "logs" : folder;
  const auto files = log_files(logs);
  if (files.empty())
    throw std::runtime_error(
        fmt::format("{}: found no log files (*.log), accepted the folder of a run's report", folder.string()));
  using Timed = std::pair<std::chrono::system_clock::time_point, LogEntry>;
  std::vector<Timed> timed;
  for (const auto& file : files) {
    // A clock that was set back must not tear the lines of a process apart.
    std::chrono::system_clock::time_point latest{};
    for (auto& entry : read_log_file(file, filter)) {
      latest = std::max(latest, entry.record.time);
      timed.emplace_back(latest, std::move(entry));
    }
  }
  std::stable_sort(timed.begin(), timed.end(), [](const Timed& a, const Timed& b) { return a.first < b.first; });
  std::vector<LogEntry> sorted;
  sorted.reserve(timed.size());
  for (auto& [time, entry] : timed) sorted.push_back(std::move(entry));
  return sorted;
}

}  // namespace constrictor::cli
