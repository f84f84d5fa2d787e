// The Debian package of Cyclone DDS is built with type discovery; its headers leave the macro to their user.
#define DDS_HAS_TYPE_DISCOVERY 1
#include "cyclone/discovery.hpp"

#include <dds/ddsi/ddsi_xqos.h>

// After ddsi_xqos.h: it uses its types without including it.
#include <dds/ddsi/ddsi_typelib.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "constrictor/hex.hpp"
#include "constrictor/text.hpp"

namespace constrictor::dds {
namespace {

Guid guid_of(const dds_guid_t& key) {
  Guid guid{};
  std::memcpy(guid.data(), key.v, guid.size());
  return guid;
}

std::string take_text(void* text, std::size_t size) {
  std::string copy = printable({static_cast<const char*>(text), text ? size : 0});
  dds_free(text);
  return copy;
}

std::string property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value) || !value) return {};
  return take_text(value, std::strlen(value));
}

EndpointQos qos_of(const dds_qos_t* qos) {
  EndpointQos found;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  if (dds_qget_reliability(qos, &reliability, nullptr)) found.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  if (dds_qget_durability(qos, &durability)) found.transient_local = durability != DDS_DURABILITY_VOLATILE;
  dds_history_kind_t history = DDS_HISTORY_KEEP_LAST;
  std::int32_t depth = 1;
  if (dds_qget_history(qos, &history, &depth)) {
    found.keep_all = history == DDS_HISTORY_KEEP_ALL;
    found.depth = depth;
  }
  dds_data_representation_id_t* ids = nullptr;
  std::uint32_t count = 0;
  if (dds_qget_data_representation(qos, &count, &ids) && ids) found.representations.assign(ids, ids + count);
  dds_free(ids);
  char** names = nullptr;
  if (dds_qget_partition(qos, &count, &names) && names) {
    for (std::uint32_t i = 0; i < count; ++i) found.partitions.push_back(take_text(names[i], std::strlen(names[i])));
    dds_free(names);
  }
  dds_duration_t lease = DDS_INFINITY;
  if (dds_qget_liveliness(qos, nullptr, &lease)) {
    found.lease_s = lease == DDS_INFINITY ? std::numeric_limits<double>::infinity() : static_cast<double>(lease) * 1e-9;
  }
  return found;
}

/// Reads without taking: the built-in topics keep what is alive.
template <class T, class Use>
void read_alive(dds_entity_t reader, Use&& use) {
  constexpr std::size_t kMost = 8192;
  std::vector<void*> samples(kMost);
  std::vector<dds_sample_info_t> infos(kMost);
  const int count = check(dds_read_mask(reader, samples.data(), infos.data(), kMost, kMost,
                                        DDS_ALIVE_INSTANCE_STATE | DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE),
                          "dds_read");
  const Loan loan(reader, samples.data(), count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (infos[i].valid_data) use(*static_cast<const T*>(samples[i]));
  }
}

Endpoint endpoint_of(const dds_builtintopic_endpoint_t& sample, bool writer) {
  Endpoint endpoint;
  endpoint.guid = guid_of(sample.key);
  endpoint.participant = guid_of(sample.participant_key);
  endpoint.writer = writer;
  // RTPS: the last byte of the entity id is the kind of the endpoint; x2 and x7 are the kinds with a key.
  const int kind = endpoint.guid[15] & 0x0f;
  endpoint.keyed = kind == 2 || kind == 7;
  endpoint.topic = printable(sample.topic_name);
  endpoint.type = printable(sample.type_name);
  endpoint.qos = qos_of(sample.qos);
  void* data = nullptr;
  std::size_t size = 0;
  if (dds_qget_userdata(sample.qos, &data, &size)) endpoint.user_data = take_text(data, size);
  const dds_typeinfo_t* info = nullptr;
  auto* readable = const_cast<dds_builtintopic_endpoint_t*>(&sample);  // the C API lacks a const here
  if (dds_builtintopic_get_endpoint_type_info(readable, &info) == DDS_RETCODE_OK && info &&
      ddsi_typeinfo_present(info)) {
    endpoint.type_info = std::shared_ptr<const void>(ddsi_typeinfo_dup(info), [](const void* own) {
      auto* type_info = static_cast<ddsi_typeinfo_t*>(const_cast<void*>(own));
      ddsi_typeinfo_fini(type_info);
      dds_free(type_info);
    });
  }
  return endpoint;
}

}  // namespace

Discovery::Discovery(dds_entity_t participant)
    : participants_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
                    "dds_create_reader"),
      writers_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
               "dds_create_reader"),
      readers_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr),
               "dds_create_reader") {
  dds_guid_t guid{};
  check(dds_get_guid(participant, &guid), "dds_get_guid");
  self_ = guid_of(guid);
}

std::vector<Participant> Discovery::participants() const {
  std::vector<Participant> list;
  read_alive<dds_builtintopic_participant_t>(participants_.get(), [&](const dds_builtintopic_participant_t& sample) {
    Participant found{guid_of(sample.key), property(sample.qos, "__Hostname"), 0,
                      property(sample.qos, "__ProcessName")};
    const std::string pid = property(sample.qos, "__Pid");
    if (!pid.empty() && pid.find_first_not_of("0123456789") == std::string::npos && pid.size() < 12)
      found.pid = std::stoll(pid);
    if (found.guid != self_) list.push_back(found);
  });
  return list;
}

std::vector<Endpoint> Discovery::endpoints() const {
  std::vector<Endpoint> list;
  for (const bool writer : {true, false}) {
    read_alive<dds_builtintopic_endpoint_t>((writer ? writers_ : readers_).get(),
                                            [&](const dds_builtintopic_endpoint_t& sample) {
                                              Endpoint endpoint = endpoint_of(sample, writer);
                                              if (endpoint.participant != self_) list.push_back(std::move(endpoint));
                                            });
  }
  std::stable_sort(list.begin(), list.end(), [](const Endpoint& a, const Endpoint& b) { return a.topic < b.topic; });
  return list;
}

bool Discovery::writers_changed() const {
  std::uint32_t status = 0;
  check(dds_get_status_changes(writers_.get(), &status), "dds_get_status_changes");
  return (status & DDS_DATA_AVAILABLE_STATUS) != 0;
}

Endpoint own_endpoint(dds_entity_t own, const dds_topic_descriptor_t& type) {
  const Qos qos = make_qos();
  check(dds_get_qos(own, qos.get()), "dds_get_qos");
  Endpoint endpoint;
  endpoint.keyed = type.m_nkeys > 0;
  endpoint.type = type.m_typename;
  endpoint.qos = qos_of(qos.get());
  return endpoint;
}

std::string describe(const EndpointQos& qos) {
  return fmt::format("{}, {}, {}{}", qos.reliable ? "reliable" : "best effort",
                     qos.transient_local ? "transient-local" : "volatile",
                     qos.keep_all ? "keep-all" : fmt::format("keep-last {}", qos.depth),
                     qos.partitions.empty() ? "" : fmt::format(", partition {}", fmt::join(qos.partitions, " ")));
}

std::string mismatch(const Endpoint& writer, const Endpoint& reader) {
  if (writer.type != reader.type)
    return fmt::format("type: the writer's is {}, the reader's {}", writer.type, reader.type);
  if (writer.keyed != reader.keyed)
    return fmt::format("key: the writer has {}, the reader {}", writer.keyed ? "one" : "none",
                       reader.keyed ? "one" : "none");
  if (reader.qos.reliable && !writer.qos.reliable)
    return "reliability: the writer offers best effort, the reader requests reliable";
  if (reader.qos.transient_local && !writer.qos.transient_local) {
    return "durability: the writer offers volatile, the reader requests transient-local";
  }
  // An empty list stands for XCDR1 alone.
  const std::int16_t offered =
      writer.qos.representations.empty() ? std::int16_t{0} : writer.qos.representations.front();
  const auto& wanted = reader.qos.representations;
  if (wanted.empty() ? offered != 0 : std::count(wanted.begin(), wanted.end(), offered) == 0) {
    return fmt::format("encoding: the writer writes XCDR{}, the reader does not read it", offered == 0 ? 1 : 2);
  }
  const auto& a = writer.qos.partitions;
  const auto& b = reader.qos.partitions;
  const auto meets = [](const std::string& x, const std::string& y) { return x == y || x == "*" || y == "*"; };
  const bool shared =
      a.empty() ? b.empty() || std::count(b.begin(), b.end(), "") > 0
                : std::any_of(a.begin(), a.end(), [&](const auto& x) {
                    return b.empty() ? x.empty()
                                     : std::any_of(b.begin(), b.end(), [&](const auto& y) { return meets(x, y); });
                  });
  if (!shared)
    return fmt::format("partition: the writer is in '{}', the reader in '{}'", fmt::join(a, " "), fmt::join(b, " "));
  return {};
}

std::string short_name(const Guid& guid) { return hex(std::span(guid).first<12>()); }

}  // namespace constrictor::dds
