#include "cli/recording/replayed_topics.hpp"

#include <algorithm>

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
}  // namespace constrictor::cli
