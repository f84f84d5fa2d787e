// Watching the samples of one topic: what `topic echo`, `topic hz` and `topic delay` do.
#pragma once

#include <cstdint>
#include <string>

#include "cli/introspection/domain_view.hpp"

namespace constrictor::cli {

struct WatchOptions {
  std::string topic;
  std::uint64_t count = 0;   ///< echo: samples; 0: until interrupted
  double timeout_s = 10.0;   ///< [s] without a sample
  double for_s = 0.0;        ///< [s] hz, delay; 0: until interrupted
  std::string field;         ///< echo: path of a field, dots between its parts; empty: all
  bool raw = false;
};

// Each returns the exit status: 0, or 1 if no sample came in time.
int echo_command(const ViewOptions& view, const WatchOptions& options);
int hz_command(const ViewOptions& view, const WatchOptions& options);
int delay_command(const ViewOptions& view, const WatchOptions& options);

}  // namespace constrictor::cli
