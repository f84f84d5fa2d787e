// How a replay treats each topic.
#pragma once

#include <cstddef>
#include <string>

#include "cli/recording/player.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor::cli {

/// Commands to a run and proofs of membership: no process may obey them again.
[[nodiscard]] bool is_command(const std::string& topic);
/// The depth of the writer's history.
[[nodiscard]] int depth_of(const std::string& topic);
/// How many of the last messages before the beginning are published: more than one if a later message of the topic does
/// not replace the earlier ones.
[[nodiscard]] std::size_t kept_before(const std::string& topic);

/// Throws UsageError if nothing of a recording with these contents would be replayed.
void refuse_empty_choice(const PlayOptions& options, const mcap::Contents& contents);

}  // namespace constrictor::cli
