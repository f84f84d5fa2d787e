#include "ros_bridge/ros_node.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {
namespace {

/// The id of a DDS entity as ROS 2 writes it: the 16 bytes of its GUID, then zeros.
template <class Gid>
Gid gid_of(const dds_guid_t& guid) {
  static_assert(sizeof(Gid::data) >= sizeof(guid.v));
  Gid gid{};
  std::memcpy(gid.data, guid.v, sizeof(guid.v));
  return gid;
}

dds_guid_t guid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  dds::check(dds_get_guid(entity, &guid), "dds_get_guid");
  return guid;
}

}  // namespace

std::string ros_type_name(const std::string& dds_type) {
  constexpr std::string_view kModule = "dds_::";
  std::string name = dds_type;
  if (const auto at = name.find(kModule); at != std::string::npos) name.erase(at, kModule.size());
  if (name.ends_with('_')) name.pop_back();
  for (auto at = name.find("::"); at != std::string::npos; at = name.find("::")) name.replace(at, 2, "/");
  return name;
}

Node::Node(dds_entity_t participant, std::string name, Release release)
    : participant_(participant), name_(std::move(name)), release_(release) {}

void Node::add(dds_entity_t entity, const std::string& topic, const dds_topic_descriptor_t& type, bool written) {
  (written ? writers_ : readers_).push_back(guid_of(entity));
  topics_.push_back({"/" + topic, ros_type_name(type.m_typename), written});
}

dds_entity_t Node::create_reader(const dds_topic_descriptor_t& type, const std::string& topic, int depth,
                                 Reliability reliability, const std::string& user_data) const {
  const dds::Qos qos = dds::make_qos();
  if (reliability == Reliability::kReliable) dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  else dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  const dds::Entity entity(dds_create_topic(participant_, &type, ("rt/" + topic).c_str(), nullptr, nullptr),
                           "dds_create_topic");
  return dds::check(dds_create_reader(participant_, entity.get(), qos.get(), nullptr), "dds_create_reader");
}

template <class Info, class Entities, class Gid>
void Node::publish(const dds_topic_descriptor_t& type) {
  const auto gids = [](const std::vector<dds_guid_t>& guids) {
    std::vector<Gid> list;
    for (const auto& guid : guids) list.push_back(gid_of<Gid>(guid));
    return list;
  };
  auto readers = gids(readers_);
  auto writers = gids(writers_);
  std::vector<Entities> nodes(1);
  std::strcpy(nodes[0].node_namespace, "/");
  const std::size_t length = std::min(name_.size(), sizeof(nodes[0].node_name) - 1);
  std::memcpy(nodes[0].node_name, name_.data(), length);
  borrow(nodes[0].reader_gid_seq, readers);
  borrow(nodes[0].writer_gid_seq, writers);
  Info info{};
  info.gid = gid_of<Gid>(guid_of(participant_));
  borrow(info.node_entities_info_seq, nodes);
  // The topic has no prefix "rt/": it belongs to the rmw implementations, not to ROS programs.
  using Described = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
  const std::string user_data = release_ == Release::kHumble ? "" : type_user_data<Described>();
  if (!graph_)
    graph_ =
        dds::Entity(dds::create_writer(participant_, type, "ros_discovery_info", 1, user_data), "dds_create_writer");
  dds::check(dds_write(graph_.get(), &info), "dds_write");
}

void Node::announce() {
  if (release_ == Release::kIron) {
    publish<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_, rmw_dds_common_msg_dds__NodeEntitiesInfo_,
            rmw_dds_common_msg_dds__Gid_>(rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc);
    return;
  }
  // Humble's message has the same name with longer ids. One IDL file cannot define a name twice.
  dds_topic_descriptor_t type = rmw_dds_common_msg_dds__HumbleParticipantEntitiesInfo__desc;
  type.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
  publish<rmw_dds_common_msg_dds__HumbleParticipantEntitiesInfo_, rmw_dds_common_msg_dds__HumbleNodeEntitiesInfo_,
          rmw_dds_common_msg_dds__HumbleGid_>(type);
}

}  // namespace constrictor::ros_bridge
