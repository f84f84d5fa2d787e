// A participant in a domain, with the loopback configuration unless the environment asks for another.
#pragma once

#include <cstdint>

#include "runtime/dds/entity.hpp"

namespace constrictor::dds {

/// How far a participant without $CYCLONEDDS_URI is heard.
enum class Reach {
  kLoopback,  ///< the loopback interface only, without multicast, up to 120 participants on this host
  kNetwork,   ///< Cyclone DDS's own default, as ROS 2's processes have it
};

/// Joins `domain`; each domain once in a process. Throws Error.
class Domain {
 public:
  explicit Domain(std::uint32_t domain, Reach reach = Reach::kLoopback);
  [[nodiscard]] dds_entity_t participant() const { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

}  // namespace constrictor::dds
