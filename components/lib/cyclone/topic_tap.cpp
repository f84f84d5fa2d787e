#include "cyclone/topic_tap.hpp"

#include <fmt/format.h>

namespace constrictor::dds {
namespace {

constexpr auto kTypeBound = std::chrono::milliseconds(500);  // until a process has described its type

}  // namespace

TopicTap::TopicTap(dds_entity_t participant, Wanted wanted, bool everything)
    : participant_(participant),
      wanted_(std::move(wanted)),
      everything_(everything),
      discovery_(participant),
      wait_set_(participant) {}

Ros2Schema TopicTap::schema_of(const Endpoint& writer) const {
  auto tree = TypeTree::find(participant_, writer, kTypeBound);
  if (!tree) tree = TypeTree::known(participant_, writer.type);
  return tree ? tree->ros2_schema() : Ros2Schema{"", "", "its writer does not describe its type"};
}

void TopicTap::read(const Endpoint& writer) {
  const std::string key =
      fmt::format("{}\n{}\n{}\n{}", writer.topic, writer.type, writer.keyed, fmt::join(writer.qos.partitions, "\n"));
  const auto known = readings_.find(key);
  RawQos offered{writer.qos.reliable, writer.qos.reliable && writer.qos.transient_local, everything_};
  if (known == readings_.end()) {
    Reading reading{{writer.topic, writer.type, writer.keyed, schema_of(writer)}, offered, nullptr, 0};
    reading.reader = std::make_unique<RawReader>(participant_, writer, offered);
    wait_set_.attach(reading.reader->get());
    readings_.emplace(key, std::move(reading));
    return;
  }
  // DDS does not match a reader with a writer that offers less than the reader requests.
  Reading& reading = known->second;
  const RawQos least{reading.qos.reliable && offered.reliable, reading.qos.transient_local && offered.transient_local,
                     everything_};
  if (least.reliable == reading.qos.reliable && least.transient_local == reading.qos.transient_local) return;
  if (reading.reader) reading.lost_before += reading.reader->lost();
  reading.reader.reset();
  reading.reader = std::make_unique<RawReader>(participant_, writer, least);
  reading.qos = least;
  wait_set_.attach(reading.reader->get());
}

void TopicTap::expect(const std::string& topic, const std::string& type, bool keyed, bool transient_local) {
  Endpoint writer;
  writer.topic = topic;
  writer.type = type;
  writer.keyed = keyed;
  writer.qos.reliable = true;
  writer.qos.transient_local = transient_local;
  read(writer);
}

void TopicTap::discover() {
  if (!discovery_.writers_changed()) return;
  for (const auto& endpoint : discovery_.endpoints()) {
    if (!endpoint.writer || !wanted_(endpoint.topic) || refused_.contains(endpoint.topic)) continue;
    try {
      read(endpoint);
    } catch (const Error& error) {
      refused_[endpoint.topic] = error.what();
    }
  }
}

void TopicTap::wait(std::chrono::milliseconds bound) const { wait_set_.wait(bound); }

void TopicTap::take(const std::function<void(const Topic&, const RawSample&)>& use) const {
  for (const auto& [key, reading] : readings_) {
    if (reading.reader)
      reading.reader->take([&, &topic = reading.topic](const RawSample& sample) { use(topic, sample); });
  }
}

std::map<std::string, std::uint64_t> TopicTap::lost() const {
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [key, reading] : readings_) {
    const std::uint64_t lost = reading.lost_before + (reading.reader ? reading.reader->lost() : 0);
    if (lost > 0) counts[reading.topic.name] += lost;
  }
  return counts;
}

std::vector<const TopicTap::Topic*> TopicTap::topics() const {
  std::vector<const Topic*> list;
  for (const auto& [key, reading] : readings_) list.push_back(&reading.topic);
  return list;
}

}  // namespace constrictor::dds
