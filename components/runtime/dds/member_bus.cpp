#include "runtime/dds/member_bus.hpp"

#include <algorithm>
#include <sstream>

namespace constrictor::dds {
namespace {

template <class T>
const dds_topic_descriptor_t* descriptor_of(const Topic<T>&) {
  return &descriptor<T>();
}

const dds_topic_descriptor_t& descriptor_of_id(std::size_t topic_id) {
  static const auto descriptors = std::apply(
      [](const auto&... topic) { return std::array<const dds_topic_descriptor_t*, topics::kCount>{descriptor_of(topic)...}; },
      topics::kAll);
  return *descriptors.at(topic_id);
}

bool names(const std::vector<std::string>& identities, std::string_view component) {
  for (const auto& identity : identities) {
    std::istringstream list(identity);
    for (std::string name; std::getline(list, name, ',');) {
      if (name == component) return true;
    }
  }
  return false;
}

}  // namespace

MemberBus::MemberBus(dds_entity_t participant, std::uint64_t reads, std::uint64_t writes, const std::string& identity) {
  for (const auto& topic : topics::kInfos) {
    const std::string name(topic.name);
    if (writes >> topic.id & 1) {
      writers_[topic.id] =
          Entity(create_writer(participant, descriptor_of_id(topic.id), name, topic.depth, identity), "dds_create_writer");
    }
    if (reads >> topic.id & 1) {
      readers_[topic.id] =
          Entity(create_member_reader(participant, descriptor_of_id(topic.id), name, identity), "dds_create_reader");
    }
  }
}

void MemberBus::write(const TopicInfo& topic, const Sample& sample) const {
  check(dds_write(writers_[topic.id].get(), sample.message.get()), "dds_write");
}

std::vector<std::pair<std::size_t, dds_entity_t>> MemberBus::readers() const {
  std::vector<std::pair<std::size_t, dds_entity_t>> list;
  for (std::size_t id = 0; id < readers_.size(); ++id) {
    if (readers_[id]) list.emplace_back(id, readers_[id].get());
  }
  return list;
}

void MemberBus::take(std::size_t topic_id, const std::function<void(const Sample&)>& use) const {
  const auto& ops = topic_ops(topic_id);
  take_all(readers_[topic_id].get(), [&](const void* message) { use(ops.copy(message)); });
}

std::string MemberBus::unmatched(const std::map<std::size_t, std::vector<std::string>>& readers_of) const {
  for (const auto& topic : topics::kInfos) {
    const std::string name(topic.name);
    if (readers_[topic.id] && !names(matched_user_data(readers_[topic.id].get(), false), topic.writer)) {
      return name + ": the reader here (reliable, keep-all, transient-local) has not met the writer of " +
             std::string(topic.writer) + " (reliable, keep-last " + std::to_string(topic.depth) + ", transient-local)";
    }
    const auto readers = readers_of.find(topic.id);
    if (!writers_[topic.id] || readers == readers_of.end()) continue;
    const auto identities = matched_user_data(writers_[topic.id].get(), true);
    for (const auto& reader : readers->second) {
      if (!names(identities, reader)) {
        return name + ": the writer here (reliable, keep-last " + std::to_string(topic.depth) +
               ", transient-local) has not met the reader of " + reader + " (reliable, keep-all, transient-local)";
      }
    }
  }
  return {};
}

}  // namespace constrictor::dds
