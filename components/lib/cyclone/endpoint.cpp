#include "cyclone/endpoint.hpp"

namespace constrictor::dds {
namespace {

/// The topic entity is needed only to create the endpoint: DDS keeps it as long as it is in use.
dds_entity_t create_endpoint(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                             const dds_qos_t* qos, bool writer, const ReaderGuard& guard = {}) {
  // No topic QoS, so that two endpoints of one topic in a participant may have different QoS.
  const Entity entity(dds_create_topic(participant, &type, topic.c_str(), nullptr, nullptr), "dds_create_topic");
  if (guard.passes)
    check(dds_set_topic_filter_and_arg(entity.get(), guard.passes, guard.argument), "dds_set_topic_filter_and_arg");
  return check(writer ? dds_create_writer(participant, entity.get(), qos, nullptr)
                      : dds_create_reader(participant, entity.get(), qos, guard.listener),
               writer ? "dds_create_writer" : "dds_create_reader");
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
  const auto get = is_writer ? dds_get_matched_subscriptions : dds_get_matched_publications;
  std::vector<dds_instance_handle_t> handles(256);
  int count = check(get(endpoint, handles.data(), handles.size()), "dds_get_matched");
  if (static_cast<std::size_t>(count) > handles.size()) {  // strangers may have any number of endpoints
    handles.resize(static_cast<std::size_t>(count));
    count = check(get(endpoint, handles.data(), handles.size()), "dds_get_matched");
  }
  std::vector<std::string> found;
  for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(count), handles.size()); ++i) {
    dds_builtintopic_endpoint_t* data = is_writer ? dds_get_matched_subscription_data(endpoint, handles[i])
                                                  : dds_get_matched_publication_data(endpoint, handles[i]);
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
