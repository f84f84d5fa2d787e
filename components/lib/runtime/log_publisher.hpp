// Publishes the lines of a log on the topic `log`.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"
#include "cyclone/endpoint.hpp"
#include "log/log.hpp"
#include "runtime/rate_limit.hpp"

namespace constrictor {

/// Lines are published in the thread that logs them. That does not delay it: the writer never waits for a reader, and a
/// process that logs without end publishes only part of its lines, which readers see by the gaps in LogLine.number.
class LogPublisher {
 public:
  static constexpr int kMostInfo = 100;     ///< limit of the informative lines that are published in a second
  static constexpr int kMostTrouble = 200;  ///< the same for warnings and errors together

  /// `process`: names of the components of this process, comma separated, or the name of the program. Lines about one
  /// of several components carry its name. The log must not be destroyed before this object. If the topic cannot
  /// be written, a warning is logged and nothing is published.
  LogPublisher(dds_entity_t participant, Log log, const std::string& process, std::uint32_t incarnation);
  ~LogPublisher();
  LogPublisher(const LogPublisher&) = delete;
  LogPublisher& operator=(const LogPublisher&) = delete;

 private:
  void publish(const LogRecord& record);

  Log log_;
  std::string process_;
  msg::LogLine line_{};  ///< with what is the same in all lines
  RateLimit info_{kMostInfo};
  RateLimit trouble_{kMostTrouble};
  dds::Writer<msg::LogLine> writer_;
};

}  // namespace constrictor
