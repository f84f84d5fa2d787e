#include "runtime/dds/outside_link.hpp"

#include "constrictor/reflect.hpp"

namespace constrictor::dds {

OutsideLink::OutsideLink(dds_entity_t participant, std::uint16_t robot_id) : robot_id_(robot_id) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  // A dead source's instance is forgotten once its end was taken: sources come and go.
  dds_qset_reader_data_lifecycle(qos.get(), DDS_SECS(1), DDS_SECS(1));
  const Entity topic(dds_create_topic(participant, &descriptor<msg::Request>(), kRequestTopic, nullptr, nullptr), "dds_create_topic");
  reader_ = Entity(dds_create_reader(participant, topic.get(), qos.get(), nullptr), "dds_create_reader");
}

void OutsideLink::take(OutsideRequests& outside, const std::function<void(const std::string&)>& refused) const {
  for (;;) {
    void* message = nullptr;  // one at a time: a few requests a tick, and the loan is simple
    dds_sample_info_t info{};
    const int count = check(dds_take(reader_.get(), &message, &info, 1, 1), "dds_take");
    if (count == 0) return;
    struct Loan {
      dds_entity_t reader;
      void** message;
      ~Loan() { dds_return_loan(reader, message, 1); }
    } const loan{reader_.get(), &message};
    const auto& request = *static_cast<const msg::Request*>(message);
    if (request.robot_id != robot_id_) continue;
    if (info.valid_data) {
      if (const auto violation = validate(request)) refused(std::string(kRequestTopic) + "." + *violation);
      else outside.add(request);
    }
    if (info.instance_state != DDS_IST_ALIVE) outside.add_death(request.source);
  }
}

RequestWriter::RequestWriter(dds_entity_t participant, std::int64_t lease_ns) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 64);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  if (lease_ns > 0) dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, lease_ns);
  const Entity topic(dds_create_topic(participant, &descriptor<msg::Request>(), kRequestTopic, nullptr, nullptr), "dds_create_topic");
  writer_ = Entity(dds_create_writer(participant, topic.get(), qos.get(), nullptr), "dds_create_writer");
}

bool RequestWriter::heard() const {
  dds_publication_matched_status_t status{};
  check(dds_get_publication_matched_status(writer_.get(), &status), "dds_get_publication_matched_status");
  return status.current_count > 0;
}

}  // namespace constrictor::dds
