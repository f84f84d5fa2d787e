// A DDS domain without a participant, for programs whose participant needs a quality of service of its own.
#pragma once

#include <cstdint>
#include <string>

#include "cyclone/domain.hpp"
#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// Configures `domain` for this process as Domain does, before the first participant in it is created. The entity must
/// outlive the participants. It is empty if Cyclone DDS's default or $CYCLONEDDS_URI alone configures the domain.
/// `settings`: XML that is added to the configuration, also to that of $CYCLONEDDS_URI, but not to the default; empty:
/// none. Throws Error.
[[nodiscard]] Entity create_domain(std::uint32_t domain, Reach reach, const std::string& settings = {});

}  // namespace constrictor::dds
