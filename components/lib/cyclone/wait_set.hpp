// Waits for samples of several readers.
#pragma once

#include <chrono>
#include <cstdint>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// Lets a reader wake wait sets only when samples arrive. Does nothing if that is so already, because the status mask
/// of a reader that WriterBook watches must not be changed.
inline void wake_by_samples_only(dds_entity_t reader) {
  std::uint32_t mask = 0;
  check(dds_get_status_mask(reader, &mask), "dds_get_status_mask");
  if (mask != DDS_DATA_AVAILABLE_STATUS)
    check(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "dds_set_status_mask");
}

class WaitSet {
 public:
  WaitSet() = default;
  explicit WaitSet(dds_entity_t participant) : entity_(dds_create_waitset(participant), "dds_create_waitset") {}
  /// `reader` must outlive the last wait().
  void attach(dds_entity_t reader) const {
    wake_by_samples_only(reader);
    check(dds_waitset_attach(entity_.get(), reader, 0), "dds_waitset_attach");
  }
  /// Returns when an attached reader has samples, or after `bound`.
  void wait(std::chrono::milliseconds bound) const {
    check(dds_waitset_wait(entity_.get(), nullptr, 0, DDS_MSECS(bound.count())), "dds_waitset_wait");
  }

 private:
  Entity entity_;
};

}  // namespace constrictor::dds
