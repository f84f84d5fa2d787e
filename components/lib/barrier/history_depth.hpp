// Whether the history that the topics keep is long enough for the latencies of the members.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "barrier/protocol.hpp"

namespace constrictor {

/// Number of samples that a topic must keep for a restarted reader, if its writer writes one every `interval` ticks.
/// The reader repeats tick k, for which it needs the newest sample that is visible at k. Meanwhile the run has gone on
/// to tick k + reader_latency - 1 at most, and the writer may have finished its step of that tick. `writer_latency`
/// [ticks] is 0 for the plant, whose samples are visible at the tick at which they are written.
[[nodiscard]] int needed_history(int writer_latency, int interval, int reader_latency);

/// Compares the latencies of all members of a run with the depths of the topics between them, and with the depth of
/// TickDone. Returns the reason why a member could not be restarted, or why its messages could be lost; empty if
/// everything fits. `plant`: name of the component that is the plant.
[[nodiscard]] std::optional<std::string> depth_violation(const std::vector<Hello>& members, const std::string& plant);

}  // namespace constrictor
