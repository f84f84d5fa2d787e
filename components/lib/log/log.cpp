#include "log/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "constrictor/text.hpp"

namespace constrictor {

Log::Log(const std::string& name)
    : logger_(std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>())) {
  logger_->set_formatter(
      std::make_unique<spdlog::pattern_formatter>("%Y-%m-%dT%H:%M:%S.%eZ %l %n: %v", spdlog::pattern_time_type::utc));
}

void Log::write(Level level, const std::string& text) const {
  // Lines contain texts of messages from the network.
  const std::string clean = printable(text, "\n\t");
  switch (level) {
    case Level::kInfo:
      return logger_->info("{}", clean);
    case Level::kWarning:
      return logger_->warn("{}", clean);
    case Level::kError:
      return logger_->error("{}", clean);
  }
}

}  // namespace constrictor
