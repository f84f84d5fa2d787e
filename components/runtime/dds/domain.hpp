// A participant in a domain, with the loopback configuration unless the environment asks for another.
#pragma once

#include <cstdint>

#include "runtime/dds/entity.hpp"

namespace constrictor::dds {

/// Joins `domain`. Without $CYCLONEDDS_URI it uses the loopback interface only, without multicast, for up to 120
/// participants on this host. Throws Error.
class Domain {
 public:
  explicit Domain(std::uint32_t domain);
  [[nodiscard]] dds_entity_t participant() const { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

}  // namespace constrictor::dds
