// A thread that reads topics of the run's domain which no tick counts, also those of other programs, for RunRecorder.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "cyclone/topic_tap.hpp"
#include "log/log.hpp"
#include "runtime/recording_sink.hpp"

namespace constrictor {

class DomainTap {
 public:
  struct Arrived {
    const RecordedChannel* channel;
    std::uint64_t source_time_ns;  ///< wall time
    std::string cdr;
  };
  /// Reads the topics for which `wanted` returns true, with a participant of its own. Throws dds::Error. `log` receives
  /// the error that ends the reading.
  DomainTap(std::uint32_t domain, const std::string& identity, dds::TopicTap::Wanted wanted, const Log& log);
  ~DomainTap();
  DomainTap(const DomainTap&) = delete;
  DomainTap& operator=(const DomainTap&) = delete;

  /// The messages that have arrived since the last call. The channels live as long as this object.
  [[nodiscard]] std::vector<Arrived> take();

 private:
  void loop();
  /// The channel of a topic: made at its first sample.
  const RecordedChannel* channel_of(const dds::TopicTap::Topic& topic);

  dds::Entity participant_;
  dds::TopicTap tap_;
  std::map<const dds::TopicTap::Topic*, std::unique_ptr<RecordedChannel>> channels_;
  std::mutex mutex_;
  std::vector<Arrived> arrived_;
  std::size_t arrived_bytes_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The channel of a topic that was read from DDS. If the topic has no schema, the metadata say why.
[[nodiscard]] RecordedChannel channel_of_topic(const dds::TopicTap::Topic& topic);

}  // namespace constrictor
