// The type of RawReader and RawWriter: a sample is its encoded bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "cyclone/entity.hpp"

struct ddsi_serdata;
struct ddsi_sertype;

namespace constrictor::dds {

struct RawTopic {
  Entity entity;
  const ddsi_sertype* type = nullptr;  ///< lives as long as the entity
};

/// A topic of a type of this name without type information: it matches all types of this name. Throws Error.
[[nodiscard]] RawTopic create_raw_topic(dds_entity_t participant, const std::string& name, const std::string& type_name,
                                        bool keyed);

/// A topic of the type that `type_info` (dds_typeinfo_t) describes. It sends nothing. As long as it exists, Cyclone DDS
/// keeps what it knows of the type, also when the last process that uses it ends. Throws Error.
[[nodiscard]] RawTopic create_described_topic(dds_entity_t participant, const std::string& name,
                                              const std::string& type_name, std::shared_ptr<const void> type_info);

/// A sample with these bytes, encapsulation header included. The caller owns one reference.
[[nodiscard]] ddsi_serdata* make_raw_sample(const ddsi_sertype* type, std::span<const std::uint8_t> bytes);

/// The bytes of a sample of such a type; valid as long as the sample.
[[nodiscard]] std::span<const std::uint8_t> bytes_of_raw_sample(const ddsi_serdata* sample);

}  // namespace constrictor::dds
