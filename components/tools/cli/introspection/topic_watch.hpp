// The common part of `topic echo`, `hz`, `bw` and `delay`: waiting for the writers and the samples of topics.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/introspection/domain_view.hpp"
#include "cli/introspection/sample_view.hpp"
#include "cyclone/raw_reader.hpp"

namespace constrictor::cli {

inline constexpr int kNothingArrived = 1;  ///< exit status of a subcommand of `topic`

struct WatchOptions {
  std::vector<std::string> topics;
  std::uint64_t count = 0;  ///< echo: number of samples; 0: until interrupted
  double timeout_s = 10.0;  ///< [s] longest wait for a writer, and for a sample
  double for_s = 0.0;       ///< [s] hz, bw, delay: duration of the measurement; 0: until interrupted
  std::string field;        ///< echo: path of a field, with dots between its parts; empty: all fields
  std::string filter;       ///< echo: only samples that fulfil this expression; empty: all
  bool raw = false;         ///< echo: the encoded bytes
  SampleView shown;         ///< echo
};

/// The function of a command that receives the samples. `topic` is the index in WatchOptions::topics.
struct Watcher {
  /// Called once for each topic, when a writer was found.
  std::function<void(const DomainView&, std::size_t topic, const dds::Endpoint& writer)> begin;
  /// Called for each sample; `now_s`: [s] since the watch began. Returns false to end it.
  std::function<bool(std::size_t topic, const dds::RawSample&, double now_s)> use;
  /// Called about ten times a second. May be empty.
  std::function<void(double now_s)> turn;
  bool history = false;  ///< begins with the samples that writers keep; if a count is given, with the newest of them
};

/// Watches the topics until `use` returns false, the user interrupts, `for_s` has passed, or no sample of any topic has
/// arrived for the timeout. Returns the exit status: 0, or 1 if a topic has no writer or no sample arrived in time.
/// Throws CommandError if there is no such topic.
int watch_topics(const ViewOptions& view, const WatchOptions& options, const Watcher& watcher);

// The commands. Each returns the exit status, and throws CommandError if there is no such topic. echo_command() throws
// UsageError if the filter cannot be understood.
int echo_command(const ViewOptions& view, const WatchOptions& options);
int hz_command(const ViewOptions& view, const WatchOptions& options);
int bw_command(const ViewOptions& view, const WatchOptions& options);
int delay_command(const ViewOptions& view, const WatchOptions& options);

}  // namespace constrictor::cli
