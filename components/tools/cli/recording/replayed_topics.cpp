#include "cli/recording/replayed_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/recording/topic_pattern.hpp"
#include "cli/usage.hpp"
#include "constrictor/messages.hpp"
#include "constrictor/topics.hpp"

namespace constrictor::cli {
namespace {

constexpr int kLeastDepth = 64;  // of topics with several instances, which count as one here

}  // namespace

bool is_command(const std::string& topic) {
  namespace wire = barrier_topics;
  return topic == wire::kRequest.name || topic == wire::kRunControl.name || topic == wire::kEmergencyStop.name ||
         topic == wire::kHello.name || topic == wire::kResume.name;
}

int depth_of(const std::string& topic) {
  int depth = kLeastDepth;
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) depth = info.depth;
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic) depth = std::max(depth, info.depth);
  }
  return depth;
}

std::size_t kept_before(const std::string& topic) {
  return topic == topics::kTaskEvent.name ? 50 : topic == barrier_topics::kStatus.name ? msg::kMaxMembers : 1;
}

void refuse_empty_choice(const PlayOptions& options, const mcap::Contents& contents) {
  const auto& all = contents.statistics;
  const double length_s = all.message_count > 0 ? 1e-9 * static_cast<double>(all.end_time - all.start_time) : 0.0;
  if (options.from_s > length_s)
    throw UsageError(fmt::format("--from: found {:g} s, accepted 0 to {:.2f} s, the length of the recording",
                                 options.from_s, length_s));
  const TopicPatterns patterns(options.topics);
  const auto matches = [&](const auto& entry) { return patterns.match(entry.second.topic); };
  if (!patterns.empty() && std::none_of(contents.channels.begin(), contents.channels.end(), matches))
    throw UsageError(
        fmt::format("--topic: found {}, accepted names or patterns of recorded topics (`constrictor info {}`)",
                    fmt::join(options.topics, ", "), options.file.string()));
}

}  // namespace constrictor::cli
