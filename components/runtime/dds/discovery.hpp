// Who is on a DDS domain: every participant, writer and reader that discovery tells of, whatever its type or vendor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/dds/entity.hpp"

namespace constrictor::dds {

using Guid = std::array<std::uint8_t, 16>;

/// The qualities of service that decide whether a reader and a writer meet.
struct EndpointQos {
  bool reliable = false;
  bool transient_local = false;    ///< or stronger
  bool keep_all = false;
  int depth = 1;                   ///< of keep-last
  std::vector<std::int16_t> representations;  ///< DDS_DATA_REPRESENTATION_XCDR1, _XCDR2
  std::vector<std::string> partitions;
  double lease_s = 0.0;            ///< [s] liveliness; infinity: none
};

/// A writer or reader.
struct Endpoint {
  Guid guid{};
  Guid participant{};
  bool writer = false;
  bool keyed = false;
  std::string topic;
  std::string type;
  std::string user_data;           ///< names the component for members of the barrier
  EndpointQos qos;
  std::shared_ptr<const void> type_info;  ///< dds_typeinfo_t; null: none was announced
};

/// A process's entry into the domain.
struct Participant {
  Guid guid{};
  std::string host;                ///< as Cyclone announces it; empty: unknown
  std::int64_t pid = 0;            ///< 0: unknown
  std::string program;             ///< name of the process; empty: unknown
};

/// What discovery knows, read anew at each call. Entities of `participant` itself are left out.
class Discovery {
 public:
  explicit Discovery(dds_entity_t participant);
  [[nodiscard]] std::vector<Participant> participants() const;
  [[nodiscard]] std::vector<Endpoint> endpoints() const;

 private:
  Guid self_{};
  Entity participants_;
  Entity writers_;
  Entity readers_;
};

/// A reader or writer of this process by the QoS that it has; without names and type information.
Endpoint own_endpoint(dds_entity_t own, const dds_topic_descriptor_t& type);

/// "reliable, transient-local, keep-last 8".
std::string describe(const EndpointQos& qos);
/// Why this reader cannot hear this writer although the topic is the same; empty if it can.
std::string mismatch(const Endpoint& writer, const Endpoint& reader);
/// First eight bytes in hexadecimal: enough to tell participants apart.
std::string short_name(const Guid& guid);

}  // namespace constrictor::dds
