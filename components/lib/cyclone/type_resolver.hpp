// The descriptions of types, as the processes that use them send them.
#pragma once

#include <dds/dds.h>

#include <chrono>
#include <memory>

struct ddsi_typeid;

namespace constrictor::dds {

struct TypeNode;

/// Requests the descriptions of the type and of all types that it contains, from the participants that announced them.
/// Null if no answer comes within `bound`, or if the description has parts that this project does not decode. A topic
/// of this process must refer to the type meanwhile (create_described_topic()).
std::shared_ptr<const TypeNode> resolve_type(dds_entity_t participant, const ddsi_typeid& id,
                                             std::chrono::milliseconds bound);

}  // namespace constrictor::dds
