#include "client/log_reader.hpp"

#include "constrictor/reflect.hpp"
#include "constrictor/text.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

/// Lines of one process that wait to be taken. A reader that does not look for some seconds loses no line of a process
/// that logs as fast as LogPublisher lets it.
constexpr int kDepth = 2048;

dds_entity_t create_reader(dds_entity_t participant) {
  const dds::Entity topic(
      dds_create_topic(participant, &dds::descriptor<msg::LogLine>(), barrier_topics::kLog, nullptr, nullptr),
      "dds_create_topic");
  const dds::Qos qos = dds::make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kDepth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  return dds_create_reader(participant, topic.get(), qos.get(), nullptr);
}

}  // namespace

LogReader::LogReader(dds_entity_t participant) : reader_(create_reader(participant), "dds_create_reader") {}

void LogReader::take(const Use& use) {
  dds::take_all_from(reader_.get(), [&](void* message, dds_instance_handle_t) {
    auto& line = *static_cast<msg::LogLine*>(message);
    if (validate(line)) return;
    dds::PrintableTexts::visit(line);
    // The number of processes that this map holds is bounded by what strangers may send: nothing is kept of the lines.
    constexpr std::size_t kMostProcesses = 1024;
    const auto key = std::pair(text_of(line.host), line.pid);
    if (newest_.size() >= kMostProcesses && !newest_.contains(key)) newest_.clear();
    const std::uint64_t before = std::exchange(newest_[key], line.number);
    use(line, before > 0 && line.number > before + 1 ? line.number - before - 1 : 0);
  });
}

bool LogReader::heard_all() const {
  const int writers =
      dds::check(dds_get_matched_publications(reader_.get(), nullptr, 0), "dds_get_matched_publications");
  return writers > 0 && newest_.size() >= static_cast<std::size_t>(writers);
}

}  // namespace constrictor
