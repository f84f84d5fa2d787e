#include "cyclone/raw_reader.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <array>
#include <span>
#include <vector>

#include "cyclone/raw_type.hpp"

namespace constrictor::dds {

RawReader::RawReader(dds_entity_t participant, const Endpoint& writer, bool history)
    : RawReader(participant, writer,
                history && writer.qos.transient_local && writer.qos.reliable ? RawQos{true, true} : RawQos{}) {}

RawReader::RawReader(dds_entity_t participant, const Endpoint& writer, RawQos wanted)
    : topic_(create_raw_topic(participant, writer.topic, writer.type, writer.keyed).entity) {
  const Qos qos = make_qos();
  dds_qset_reliability(qos.get(), wanted.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), wanted.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), wanted.keep_all ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST, 1024);
  const dds_data_representation_id_t encodings[] = {DDS_DATA_REPRESENTATION_XCDR1, DDS_DATA_REPRESENTATION_XCDR2};
  dds_qset_data_representation(qos.get(), 2, encodings);
  if (!writer.qos.partitions.empty()) {
    std::vector<const char*> names;
    for (const auto& name : writer.qos.partitions) names.push_back(name.c_str());
    dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
  }
  reader_ = Entity(dds_create_reader(participant, topic_.get(), qos.get(), nullptr), "dds_create_reader");
}

void RawReader::take(const std::function<void(const RawSample&)>& use) const {
  constexpr std::uint32_t kBatch = 64;
  for (;;) {
    std::array<ddsi_serdata*, kBatch> data{};
    std::array<dds_sample_info_t, kBatch> infos{};
    const int count =
        check(dds_takecdr(reader_.get(), data.data(), kBatch, infos.data(), DDS_ANY_STATE), "dds_takecdr");
    const std::span<ddsi_serdata*> samples(data.data(), static_cast<std::size_t>(count));
    struct Batch {
      std::span<ddsi_serdata*> samples;
      ~Batch() {
        for (ddsi_serdata* sample : samples) ddsi_serdata_unref(sample);
      }
    } const batch{samples};  // also if `use` throws
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (infos[i].valid_data) use({bytes_of_raw_sample(data[i]), infos[i].source_timestamp});
    }
    if (count < static_cast<int>(kBatch)) return;
  }
}

std::uint64_t RawReader::lost() const {
  dds_sample_lost_status_t status{};
  check(dds_get_sample_lost_status(reader_.get(), &status), "dds_get_sample_lost_status");
  return status.total_count;
}

int RawReader::writers() const {
  return check(dds_get_matched_publications(reader_.get(), nullptr, 0), "dds_get_matched_publications");
}

}  // namespace constrictor::dds
