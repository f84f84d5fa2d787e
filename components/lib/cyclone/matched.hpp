// The endpoints that a reader or writer has matched.
#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <vector>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// The handles of all readers that a writer has matched at present, or of all writers that a reader has matched. Throws
/// Error.
inline std::vector<dds_instance_handle_t> matched_endpoints(dds_entity_t endpoint, bool is_writer) {
  const auto get = is_writer ? dds_get_matched_subscriptions : dds_get_matched_publications;
  std::vector<dds_instance_handle_t> handles(256);
  auto count = static_cast<std::size_t>(check(get(endpoint, handles.data(), handles.size()), "dds_get_matched"));
  if (count > handles.size()) {  // strangers may have any number of endpoints
    handles.resize(count);
    count = static_cast<std::size_t>(check(get(endpoint, handles.data(), handles.size()), "dds_get_matched"));
  }
  handles.resize(std::min(count, handles.size()));
  return handles;
}

}  // namespace constrictor::dds
