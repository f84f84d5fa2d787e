#include "cyclone/endpoint.hpp"

#include "cyclone/matched.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor::dds {
namespace {

/// The topic entity is needed only to create the endpoint: DDS keeps it as long as it is in use.
dds_entity_t create_endpoint(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                             const dds_qos_t* qos, bool writer, const ReaderGuard& guard = {}) {
  // No topic QoS, so that two endpoints of one topic in a participant may have different QoS.
  const Entity entity(dds_create_topic(participant, &type, topic.c_str(), nullptr, nullptr), "dds_create_topic");
  if (guard.passes)
    check(dds_set_topic_filter_and_arg(entity.get(), guard.passes, guard.argument), "dds_set_topic_filter_and_arg");
  if (writer) return check(dds_create_writer(participant, entity.get(), qos, nullptr), "dds_create_writer");
  const dds_entity_t reader = check(dds_create_reader(participant, entity.get(), qos, nullptr), "dds_create_reader");
  if (!guard.book) return reader;
  wake_by_samples_only(reader);  // before watch(), see there
  guard.book->watch(reader);
  return reader;
}

void set_user_data(dds_qos_t* qos, const std::string& user_data) {
  if (!user_data.empty()) dds_qset_userdata(qos, user_data.data(), user_data.size());
}

}  // namespace

dds_entity_t create_writer(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                           int depth, const std::string& user_data) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);  // a normal exit must not dispose samples that others still read
  set_user_data(qos.get(), user_data);
  return create_endpoint(participant, type, topic, qos.get(), true);
}

dds_entity_t create_member_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, const std::string& user_data, const ReaderGuard& guard) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  set_user_data(qos.get(), user_data);
  return create_endpoint(participant, type, topic, qos.get(), false, guard);
}

dds_entity_t create_command_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                   const std::string& topic, int depth) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  return create_endpoint(participant, type, topic, qos.get(), false);
}

dds_entity_t create_observer_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                    const std::string& topic, int depth) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  return create_endpoint(participant, type, topic, qos.get(), false);
}

std::vector<std::string> matched_user_data(dds_entity_t endpoint, bool is_writer) {
  std::vector<std::string> found;
  for (const dds_instance_handle_t handle : matched_endpoints(endpoint, is_writer)) {
    dds_builtintopic_endpoint_t* data = is_writer ? dds_get_matched_subscription_data(endpoint, handle)
                                                  : dds_get_matched_publication_data(endpoint, handle);
    if (!data) continue;
    void* bytes = nullptr;
    std::size_t size = 0;
    if (data->qos && dds_qget_userdata(data->qos, &bytes, &size) && bytes) {
      found.emplace_back(static_cast<const char*>(bytes), size);
    }
    dds_free(bytes);
    dds_builtintopic_free_endpoint(data);
  }
  return found;
}

}  // namespace constrictor::dds
