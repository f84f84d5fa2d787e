// `topic echo`, `topic hz` and `topic delay`: the samples of one topic, their rate and their delay.
#pragma once

#include <cstdint>
#include <string>

#include "cli/introspection/domain_view.hpp"

namespace constrictor::cli {

struct WatchOptions {
  std::string topic;
  std::uint64_t count = 0;  ///< echo: number of samples; 0: until interrupted
  double timeout_s = 10.0;  ///< [s] longest wait for a writer, and for a sample
  double for_s = 0.0;       ///< [s] hz, delay: duration of the measurement; 0: until interrupted
  std::string field;        ///< echo: path of a field, with dots between its parts; empty: all fields
  bool raw = false;         ///< echo: the encoded bytes
};

// Each returns the exit status: 0, or 1 if no sample arrived in time. Throws CommandError if there is no such topic.
int echo_command(const ViewOptions& view, const WatchOptions& options);
int hz_command(const ViewOptions& view, const WatchOptions& options);
int delay_command(const ViewOptions& view, const WatchOptions& options);

}  // namespace constrictor::cli
