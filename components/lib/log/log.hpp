// The log lines of every process, on stderr: time (UTC), level, component or program, tick, and the message.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace constrictor {

/// One line of a log.
struct LogRecord {
  std::chrono::system_clock::time_point time{};
  std::uint8_t level = 0;    ///< kLog... of log.idl
  std::string subject;       ///< component that the line is about, or the whole process or program
  std::uint64_t run_id = 0;  ///< 0: not known yet
  std::uint32_t epoch = 0;   ///< 0: none has begun
  std::int64_t tick = -1;    ///< newest tick of the process; -1: none
  std::uint64_t number = 0;  ///< of this line among the lines of the process, from 1
  std::string text;          ///< without control characters
};

/// `2026-11-22T10:15:30.125Z warning physics tick 812: no Hello of "planner" for 2 s`. The epoch is named after the
/// first reset: `physics epoch 2 tick 812`.
[[nodiscard]] std::string log_text(const LogRecord& record);
/// The inverse; what the text does not contain is left out. Empty if the text is not a line of a log: libraries write
/// to stderr, too.
[[nodiscard]] std::optional<LogRecord> read_log_text(const std::string& text);

/// Writes lines. Thread-safe; copies write to the same log. A line names what happened and what to do; nothing is
/// logged once per tick. No result of a run depends on what is logged, and writing never waits for a reader of the
/// lines.
class Log {
 public:
  using Sink = std::function<void(const LogRecord&)>;

  /// A log that discards every line.
  Log() = default;
  /// A log on stderr. `name`: of the component, of all components of the process (`navigation,control`), or of the
  /// program.
  explicit Log(const std::string& name);
  /// A log in a file, which is continued. Throws spdlog::spdlog_ex if the file cannot be opened.
  Log(const std::string& name, const std::filesystem::path& file);

  /// The same log for lines about one component of the process.
  [[nodiscard]] Log about(const std::string& component) const;
  /// From now on lines carry this run, epoch and tick.
  void at(std::uint64_t run_id, std::uint32_t epoch, std::int64_t tick) const;
  /// From now on `sink` also receives every line, in the thread that writes it; null: no sink does. When this returns,
  /// no call of the previous sink is in progress.
  void forward(Sink sink) const;

  template <class... Values>
  void info(fmt::format_string<Values...> text, Values&&... values) const {
    write(Level::kInfo, fmt::format(text, std::forward<Values>(values)...));
  }
  template <class... Values>
  void warning(fmt::format_string<Values...> text, Values&&... values) const {
    write(Level::kWarning, fmt::format(text, std::forward<Values>(values)...));
  }
  template <class... Values>
  void error(fmt::format_string<Values...> text, Values&&... values) const {
    write(Level::kError, fmt::format(text, std::forward<Values>(values)...));
  }

 private:
  enum class Level { kInfo, kWarning, kError };
  struct Shared;
  /// A text of several lines becomes as many records.
  void write(Level level, const std::string& text) const;

  std::shared_ptr<Shared> shared_;  ///< null: lines are discarded
  std::string subject_;
};

}  // namespace constrictor
