// The participants, writers and readers in a DDS domain that discovery has found, of any type and vendor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

using Guid = std::array<std::uint8_t, 16>;

/// The qualities of service that decide whether a reader and a writer match.
struct EndpointQos {
  bool reliable = false;
  bool transient_local = false;  ///< or persistent
  bool keep_all = false;
  int depth = 1;                              ///< of keep-last
  std::vector<std::int16_t> representations;  ///< DDS_DATA_REPRESENTATION_XCDR1, _XCDR2
  std::vector<std::string> partitions;
  double lease_s = 0.0;  ///< [s] liveliness; infinity: none
};

/// A writer or reader.
struct Endpoint {
  Guid guid{};
  Guid participant{};
  bool writer = false;
  bool keyed = false;
  std::string topic;
  std::string type;
  std::string user_data;  ///< of a member's endpoint: the names of its components
  EndpointQos qos;
  std::shared_ptr<const void> type_info;  ///< dds_typeinfo_t; null: the endpoint announces none
};

/// A participant: usually one for each process.
struct Participant {
  Guid guid{};
  std::string host;      ///< announced by Cyclone only; empty: unknown
  std::int64_t pid = 0;  ///< 0: unknown
  std::string program;   ///< name of the process; empty: unknown
};

/// Each call returns what discovery knows at that time. Entities of `participant` itself are left out.
class Discovery {
 public:
  explicit Discovery(dds_entity_t participant);
  [[nodiscard]] std::vector<Participant> participants() const;
  [[nodiscard]] std::vector<Endpoint> endpoints() const;
  /// Whether a writer has come or gone since the last endpoints().
  [[nodiscard]] bool writers_changed() const;

 private:
  Guid self_{};
  Entity participants_;
  Entity writers_;
  Entity readers_;
};

/// A reader or writer of this process, with its QoS; without topic, user data and type information.
Endpoint own_endpoint(dds_entity_t own, const dds_topic_descriptor_t& type);

/// "reliable, transient-local, keep-last 8".
std::string describe(const EndpointQos& qos);
/// Why this reader and this writer of one topic do not match; empty if they do.
std::string mismatch(const Endpoint& writer, const Endpoint& reader);
/// The first twelve bytes in hexadecimal, which identify the participant.
std::string short_name(const Guid& guid);

}  // namespace constrictor::dds
