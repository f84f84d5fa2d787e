#include "runtime/member_bus.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "barrier/plant_topics.hpp"
#include "cyclone/discovery.hpp"

namespace constrictor {
namespace {

template <class T>
const dds_topic_descriptor_t* descriptor_of(const Topic<T>&) {
  return &dds::descriptor<T>();
}

const dds_topic_descriptor_t& descriptor_of_id(std::size_t topic_id) {
  static const auto descriptors = std::apply(
      [](const auto&... topic) {
        return std::array<const dds_topic_descriptor_t*, topics::kCount>{descriptor_of(topic)...};
      },
      topics::kAll);
  return *descriptors.at(topic_id);
}

/// A message as Cyclone DDS decodes it, with the bytes that its sequence points to.
template <class T>
struct Received {
  Received() = default;
  Received(const Received&) = delete;
  Received& operator=(const Received&) = delete;
  ~Received() {
    reflect::OctetsFinder octets;
    Description<T>::visit(message, octets);
    if (octets.found) dds_free(octets.found->_buffer);
  }
  T message{};
};

template <class T>
Sample decode(const ddsi_serdata* data) {
  const auto received = std::make_shared<Received<T>>();
  if (!ddsi_serdata_to_sample(data, &received->message, nullptr, nullptr)) return {};
  return {std::shared_ptr<const T>(received, &received->message), &received->message.header};
}

using Decode = Sample (*)(const ddsi_serdata*);

template <class T>
Decode decode_of(const Topic<T>&) {
  return &decode<T>;
}

Decode decode_of_id(std::size_t topic_id) {
  static const auto all = std::apply(
      [](const auto&... topic) { return std::array<Decode, topics::kCount>{decode_of(topic)...}; }, topics::kAll);
  return all.at(topic_id);
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

MemberBus::MemberBus(dds_entity_t participant, TopicSet reads, TopicSet writes, const std::string& identity,
                     dds::WriterBook* book)
    : participant_(participant) {
  const dds::ReaderGuard guard{book};
  for (const auto& topic : topics::kInfos) {
    const std::string name(topic.name);
    if (writes.contains(topic.id)) {
      writers_[topic.id] =
          dds::Entity(dds::create_writer(participant, descriptor_of_id(topic.id), name, topic.depth, identity),
                      "dds_create_writer");
    }
    if (reads.contains(topic.id)) {
      readers_[topic.id] =
          dds::Entity(dds::create_member_reader(participant, descriptor_of_id(topic.id), name, identity, guard),
                      "dds_create_reader");
    }
  }
}

void MemberBus::write(const TopicInfo& topic, const Sample& sample) const {
  dds::check(dds_write(writers_[topic.id].get(), sample.message.get()), "dds_write");
}

std::vector<std::pair<std::size_t, dds_entity_t>> MemberBus::readers() const {
  std::vector<std::pair<std::size_t, dds_entity_t>> list;
  for (std::size_t id = 0; id < readers_.size(); ++id) {
    if (readers_[id]) list.emplace_back(id, readers_[id].get());
  }
  return list;
}

void MemberBus::take(std::size_t topic_id, const std::function<void(const Sample&, dds_instance_handle_t)>& use) const {
  // Decoding at the place where the sample stays saves what dds_take() does besides: it decodes into a struct of its
  // own, of which the sample would be a copy, and clears this struct afterwards, field by field and as a whole.
  constexpr std::uint32_t kBatch = 8;
  const Decode decode = decode_of_id(topic_id);
  for (;;) {
    std::array<ddsi_serdata*, kBatch> data{};
    std::array<dds_sample_info_t, kBatch> infos{};
    const int count = dds::check(
        dds_takecdr(readers_[topic_id].get(), data.data(), kBatch, infos.data(), DDS_ANY_STATE), "dds_takecdr");
    struct Taken {
      std::array<ddsi_serdata*, kBatch>& data;
      std::size_t count;
      ~Taken() {
        for (std::size_t i = 0; i < count; ++i) ddsi_serdata_unref(data.at(i));
      }
    } const taken{data, static_cast<std::size_t>(count)};
    for (std::size_t i = 0; i < taken.count; ++i) {
      if (!infos.at(i).valid_data) continue;
      if (const Sample sample = decode(data.at(i)); sample.message) use(sample, infos.at(i).publication_handle);
    }
    if (taken.count < kBatch) return;
  }
}

Unmatched MemberBus::unmatched(const std::map<std::size_t, std::vector<std::string>>& readers_of, TopicSet unwritten,
                               const std::string& plant) const {
  for (const auto& topic : topics::kInfos) {
    if (readers_[topic.id] && !unwritten.contains(topic.id) &&
        !names(dds::matched_user_data(readers_[topic.id].get(), false), writer_in_run(topic, plant))) {
      return {&topic, true, writer_in_run(topic, plant)};
    }
    const auto readers = readers_of.find(topic.id);
    if (!writers_[topic.id] || readers == readers_of.end()) continue;
    const auto identities = dds::matched_user_data(writers_[topic.id].get(), true);
    for (const auto& reader : readers->second) {
      if (!names(identities, reader)) return {&topic, false, reader};
    }
  }
  return {};
}

std::string MemberBus::explain(const Unmatched& missing) const {
  const char* here = missing.reader ? "reader" : "writer";
  const char* there = missing.reader ? "writer" : "reader";
  const std::string topic(missing.topic->name);
  const dds::Endpoint own = dds::own_endpoint((missing.reader ? readers_ : writers_)[missing.topic->id].get(),
                                              descriptor_of_id(missing.topic->id));
  std::string text = topic + ": the " + here + " here (" + dds::describe(own.qos) + ") has not met the " + there +
                     " of " + missing.counterpart;
  // Prefer an endpoint that names the component. Otherwise use an endpoint without user data: its author may have
  // forgotten to set the name.
  std::optional<dds::Endpoint> found;
  for (auto& endpoint : dds::Discovery(participant_).endpoints()) {
    if (endpoint.topic != topic || endpoint.writer != missing.reader) continue;
    const bool named = names({endpoint.user_data}, missing.counterpart);
    if (named || (endpoint.user_data.empty() && !found)) found = std::move(endpoint);
    if (named) break;
  }
  if (!found) return text + ", which is not there";
  const std::string why = missing.reader ? dds::mismatch(*found, own) : dds::mismatch(own, *found);
  const bool nameless = found->user_data.empty();
  text += (nameless ? std::string("; there is a ") + there + " without a name (" : std::string(" (")) +
          dds::describe(found->qos) + "); ";
  if (!why.empty()) return text + why;
  return text +
         (nameless ? "its user data must be '" + missing.counterpart + "'" : "perhaps their type information differs");
}

}  // namespace constrictor
