#include "runtime/log_publisher.hpp"

#include <unistd.h>

#include <chrono>

#include "cyclone/own_host.hpp"

namespace constrictor {

LogPublisher::LogPublisher(dds_entity_t participant, Log log, const std::string& process, std::uint32_t incarnation)
    : log_(std::move(log)), process_(process) {
  try {
    writer_ = {participant, barrier_topics::kLog};
  } catch (const dds::Error& error) {
    // In a secured run with old permissions, for example. The lines are in the log file.
    log_.warning(
        "the log lines of this process are not published: {}; in a secured run, `constrictor keys` renews the "
        "rights",
        error.what());
    return;
  }
  set_text(line_.host, own_host());
  line_.pid = ::getpid();
  set_text(line_.process, process);
  line_.incarnation = incarnation;
  log_.forward([this](const LogRecord& record) { publish(record); });
}

LogPublisher::~LogPublisher() { log_.forward(nullptr); }

void LogPublisher::publish(const LogRecord& record) {
  if (!(record.level == msg::kLogInfo ? info_ : trouble_).allows(RateLimit::Clock::now())) return;
  set_text(line_.component, record.subject == process_ ? std::string() : record.subject);
  line_.run_id = record.run_id;
  line_.epoch = record.epoch;
  line_.tick = record.tick;
  line_.wall_time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(record.time.time_since_epoch()).count();
  line_.number = record.number;
  line_.level = record.level;
  set_text(line_.message, record.text);
  try {
    writer_.write(line_);
  } catch (const dds::Error&) {
    // The line is in the log file, and readers see the gap. A log line must not end a process.
  }
}

}  // namespace constrictor
