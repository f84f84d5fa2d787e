// A participant in a DDS domain, on the loopback interface unless $CYCLONEDDS_URI configures something else.
#pragma once

#include <cstdint>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// The networks on which a participant can be discovered if $CYCLONEDDS_URI is not set.
enum class Reach {
  kLoopback,  ///< the loopback interface only, without multicast, up to 120 participants on this host
  kNetwork,   ///< Cyclone DDS's default, which processes of ROS 2 use
};

/// Joins `domain`. A process can join each domain only once at a time. Throws Error.
class Domain {
 public:
  explicit Domain(std::uint32_t domain, Reach reach = Reach::kLoopback);
  [[nodiscard]] dds_entity_t participant() const { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

}  // namespace constrictor::dds
