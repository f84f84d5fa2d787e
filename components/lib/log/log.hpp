// Log lines of every process, on stderr: time (UTC), level, and the name of the component or program.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

namespace spdlog {
class logger;
}

namespace constrictor {

/// `2026-11-22T10:15:30.125Z warning physics: no Hello of "planner" for 2 s`. Thread-safe. A log line names what
/// happened and what to do; nothing is logged once per tick.
class Log {
 public:
  /// `name`: of the component, of all components of the process (`navigation,control`), or of the program.
  explicit Log(const std::string& name);

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
  void write(Level level, const std::string& text) const;

  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace constrictor
