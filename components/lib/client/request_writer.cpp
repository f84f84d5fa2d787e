#include "client/request_writer.hpp"

#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

RequestWriter::RequestWriter(dds_entity_t participant, std::int64_t lease_ns, bool by_hand) {
  const dds::Qos qos = dds::make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 64);
  // Volatile: `input` must not obey a request that was written before it started.
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  if (lease_ns > 0)
    dds_qset_liveliness(qos.get(), by_hand ? DDS_LIVELINESS_MANUAL_BY_TOPIC : DDS_LIVELINESS_AUTOMATIC, lease_ns);
  const dds::Entity topic(
      dds_create_topic(participant, &dds::descriptor<msg::Request>(), barrier_topics::kRequest, nullptr, nullptr),
      "dds_create_topic");
  writer_ = dds::Entity(dds_create_writer(participant, topic.get(), qos.get(), nullptr), "dds_create_writer");
}

bool RequestWriter::heard() const {
  dds_publication_matched_status_t status{};
  dds::check(dds_get_publication_matched_status(writer_.get(), &status), "dds_get_publication_matched_status");
  return status.current_count > 0;
}

}  // namespace constrictor
