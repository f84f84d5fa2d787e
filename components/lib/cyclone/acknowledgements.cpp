#include "cyclone/acknowledgements.hpp"

#include <algorithm>
#include <vector>

#include "cyclone/entity.hpp"

namespace constrictor::dds {
namespace {

constexpr dds_duration_t kSlice_ns = DDS_MSECS(10);

std::vector<dds_entity_t> children_of(dds_entity_t entity) {
  const auto count = check(dds_get_children(entity, nullptr, 0), "dds_get_children");
  std::vector<dds_entity_t> children(static_cast<std::size_t>(count));
  const auto found = check(dds_get_children(entity, children.data(), children.size()), "dds_get_children");
  children.resize(std::min(children.size(), static_cast<std::size_t>(found)));
  return children;
}

/// Each writer has a publisher, which is a child of the participant.
std::vector<dds_entity_t> writers_of(dds_entity_t participant) {
  std::vector<dds_entity_t> writers;
  for (const dds_entity_t group : children_of(participant)) {
    for (const dds_entity_t endpoint : children_of(group)) {
      if (dds_get_matched_subscriptions(endpoint, nullptr, 0) >= 0) writers.push_back(endpoint);
    }
  }
  return writers;
}

}  // namespace

bool wait_for_acknowledgements(dds_entity_t participant, dds_duration_t bound_ns,
                               const std::function<bool()>& give_up) {
  const dds_time_t end = dds_time() + bound_ns;
  for (const dds_entity_t writer : writers_of(participant)) {
    for (;;) {
      const dds_duration_t left = end - dds_time();
      if (dds_wait_for_acks(writer, std::clamp<dds_duration_t>(left, 0, kSlice_ns)) != DDS_RETCODE_TIMEOUT) break;
      if (left <= 0 || (give_up && give_up())) return false;
    }
  }
  return true;
}

}  // namespace constrictor::dds
