#include "cyclone/raw_writer.hpp"

#include <dds/ddsi/ddsi_serdata.h>

namespace constrictor::dds {

RawWriter::RawWriter(dds_entity_t participant, const std::string& topic, const Type& type, int depth)
    : topic_(create_raw_topic(participant, topic, type.name, type.keyed)) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, -1, -1, -1);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  const dds_data_representation_id_t encoding =
      type.xcdr2 ? DDS_DATA_REPRESENTATION_XCDR2 : DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &encoding);
  writer_ = Entity(dds_create_writer(participant, topic_.entity.get(), qos.get(), nullptr), "dds_create_writer");
}

void RawWriter::write(std::span<const std::uint8_t> cdr) const {
  // dds_writecdr() takes over the reference.
  check(dds_writecdr(writer_.get(), make_raw_sample(topic_.type, cdr)), "dds_writecdr");
}

int RawWriter::readers() const {
  return check(dds_get_matched_subscriptions(writer_.get(), nullptr, 0), "dds_get_matched_subscriptions");
}

bool RawWriter::flush(std::chrono::milliseconds bound) const {
  return dds_wait_for_acks(writer_.get(), DDS_MSECS(bound.count())) == DDS_RETCODE_OK;
}

}  // namespace constrictor::dds
