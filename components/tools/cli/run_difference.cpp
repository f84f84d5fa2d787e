#include "cli/run_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "barrier/topic_ops.hpp"
#include "cli/recording/recorded_messages.hpp"
#include "constrictor/topics.hpp"
#include "runtime/recording_options.hpp"

namespace constrictor::cli {
namespace {

using Entry = HashLog::Entry;

/// Number of last ticks whose messages may be missing from a log: the longest latency of a component, and a margin.
constexpr std::int64_t kTail = 32;

auto place(const Entry& entry) { return std::make_tuple(entry.tick, entry.topic, entry.sequence_number); }

/// Last tick that the plant sampled; -1 if none.
std::int64_t last_tick(const std::vector<Entry>& log) {
  std::int64_t last = -1;
  for (const auto& entry : log) {
    if (topics::kInfos[entry.topic].writer == topics::kJointState.writer) last = std::max(last, entry.tick);
  }
  return last;
}

RunDifference at(const Entry& entry) {
  const TopicInfo& topic = topics::kInfos[entry.topic];
  return {entry.tick, std::string(topic.writer), std::string(topic.name), "", "", "", entry.sequence_number};
}

RunDifference differing(const Entry& a, const Entry& b) {
  RunDifference difference = at(a);
  difference.a = fmt::format("hash {:016x}", a.hash);
  difference.b = fmt::format("hash {:016x}", b.hash);
  if (a.bytes.empty() || b.bytes.empty()) return difference;
  const TopicOps& ops = topic_ops(a.topic);
  const Sample left = ops.parse(std::as_bytes(std::span(a.bytes)));
  const Sample right = ops.parse(std::as_bytes(std::span(b.bytes)));
  if (!left.message || !right.message) {
    difference.a = difference.b = "unreadable";
  } else if (const auto field = ops.difference(left.message.get(), right.message.get())) {
    difference.field = field->path;
    difference.a = field->a;
    difference.b = field->b;
  }
  return difference;
}

}  // namespace

std::optional<RunDifference> first_run_difference(const std::vector<Entry>& a, const std::vector<Entry>& b) {
  const std::int64_t end_a = last_tick(a);
  const std::int64_t end_b = last_tick(b);
  const std::int64_t end = std::min(end_a, end_b);
  // A restarted member repeats its last step, so a log may contain the same message twice.
  const auto past = [](const std::vector<Entry>& log, std::size_t i) {
    const auto here = place(log[i]);
    const auto hash = log[i].hash;
    while (i < log.size() && place(log[i]) == here && log[i].hash == hash) ++i;
    return i;
  };
  const auto missing = [&](const Entry& entry, bool in_a) {
    RunDifference difference = at(entry);
    (in_a ? difference.a : difference.b) = fmt::format("message {}", entry.sequence_number);
    (in_a ? difference.b : difference.a) = "no message";
    return difference;
  };
  const auto tolerated = [&](const Entry& entry) {
    const bool plants = topics::kInfos[entry.topic].writer == topics::kJointState.writer;
    return entry.tick > end - (plants ? 0 : kTail);
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() || j < b.size()) {
    const bool only_a = j == b.size() || (i < a.size() && place(a[i]) < place(b[j]));
    const bool only_b = !only_a && (i == a.size() || place(b[j]) < place(a[i]));
    if (only_a) {
      if (!tolerated(a[i])) return missing(a[i], true);
      i = past(a, i);
    } else if (only_b) {
      if (!tolerated(b[j])) return missing(b[j], false);
      j = past(b, j);
    } else {
      if (a[i].hash != b[j].hash) return differing(a[i], b[j]);
      i = past(a, i);
      j = past(b, j);
    }
  }
  if (end_a == end_b) return std::nullopt;
  return RunDifference{end, std::string(topics::kJointState.writer), "the run's length",
                       "",  fmt::format("ends at tick {}", end_a),   fmt::format("ends at tick {}", end_b),
                       0};
}

namespace {

/// Names the field in which two messages differ, if both runs were recorded.
std::optional<RunDifference> with_field(std::optional<RunDifference> difference, const std::filesystem::path& a,
                                        const std::filesystem::path& b) {
  if (!difference || !difference->field.empty() || !difference->a.starts_with("hash")) return difference;
  const auto topic = std::find_if(topics::kInfos.begin(), topics::kInfos.end(),
                                  [&](const TopicInfo& info) { return info.name == difference->topic; });
  const auto message_in = [&](const std::filesystem::path& run) {
    const auto file = recording_of(run);
    const auto bytes = file.empty() ? std::nullopt : recorded_message(file, topic->id, difference->sequence_number);
    return Entry{difference->tick, difference->sequence_number, topic->id, 0, bytes.value_or("")};
  };
  RunDifference named = differing(message_in(a), message_in(b));
  return named.field.empty() ? difference : named;
}

std::vector<Entry> with_ticks(std::vector<Entry> log, const std::filesystem::path& file) {
  // If a run made no tick, there is nothing to compare.
  if (last_tick(log) < 0) throw std::runtime_error(file.string() + ": contains no tick");
  return log;
}

std::optional<RunDifference> compare_recordings(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const auto* run : {&a, &b}) {
    if (recording_of(*run).empty())
      throw std::runtime_error(
          fmt::format("{}: found no {}, accepted a run that was made with --record, because the "
                      "other one is given by its recording",
                      run->string(), kRecordingFile));
  }
  const auto file_a = recording_of(a);
  const auto file_b = recording_of(b);
  const bool images = has_images(file_a) && has_images(file_b);
  return with_field(first_run_difference(with_ticks(recorded_hashes(file_a, images), file_a),
                                         with_ticks(recorded_hashes(file_b, images), file_b)),
                    a, b);
}

}  // namespace

std::optional<RunDifference> compare_runs(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!std::filesystem::is_directory(a) || !std::filesystem::is_directory(b)) return compare_recordings(a, b);
  auto log_a = with_ticks(HashLog::read(a), a / "hashes.bin");
  auto log_b = with_ticks(HashLog::read(b), b / "hashes.bin");
  // A run whose disk was full has logged only its beginning.
  std::optional<std::int64_t> end;
  const std::filesystem::path* full = nullptr;
  for (const auto* directory : {&a, &b}) {
    const auto at = HashLog::full_disk_at(*directory);
    if (!at || (end && *end <= *at)) continue;
    end = at;
    full = directory;
  }
  if (!end) return with_field(first_run_difference(log_a, log_b), a, b);
  for (auto* log : {&log_a, &log_b}) std::erase_if(*log, [&](const Entry& entry) { return entry.tick >= *end; });
  if (auto difference = first_run_difference(log_a, log_b)) return with_field(std::move(difference), a, b);
  throw std::runtime_error(
      fmt::format("{}: the disk was full at tick {}, so that later messages were not logged; the runs are equal up to "
                  "this tick, and cannot be compared beyond it",
                  (*full / "hashes.bin").string(), *end));
}

}  // namespace constrictor::cli
