// A node of ROS 2, as `ros2 node list` and `ros2 topic list -v` see it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cyclone/endpoint.hpp"
#include "cyclone/entity.hpp"
#include "ros_bridge/ros_descriptors.hpp"

namespace constrictor::ros_bridge {

/// The releases of ROS 2, as far as they differ in what they exchange about nodes.
enum class Release {
  kHumble,  ///< entities have ids of 24 bytes
  kIron,    ///< and all later ones: 16 bytes
};

/// The user data of a participant that ROS 2 regards as its own.
inline constexpr const char* kRosParticipant = "enclave=/;";

/// Reads a topic of ROS 2, whose writers have the quality of service that a ROS program chose.
template <class T>
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(dds_entity_t reader) : reader_(reader, "dds_create_reader") {}
  template <class Use>
  void take(Use&& use) const {
    dds::take_all_from(reader_.get(), [&](void* message, dds_instance_handle_t) { use(*static_cast<T*>(message)); });
  }
  /// Number of living writers that it has matched.
  [[nodiscard]] int writers() const {
    return dds::check(dds_get_matched_publications(reader_.get(), nullptr, 0), "dds_get_matched_publications");
  }
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  dds::Entity reader_;
};

/// Makes the readers and writers of one node, with ROS 2's names and with type hashes, and announces them. DDS failures
/// throw dds::Error.
class Node {
 public:
  enum class Reliability { kBestEffort, kReliable };

  /// A topic that the node reads or writes, and its type, as ROS 2 names them: "/joint_states",
  /// "sensor_msgs/msg/JointState".
  struct Topic {
    std::string name, type;
    bool written = true;
  };

  /// `participant`, with the user data kRosParticipant, must outlive this object. `name`: of the node, without "/".
  Node(dds_entity_t participant, std::string name, Release release);

  /// A writer that every reader of ROS 2 matches: reliable, transient-local. It keeps the last `depth` samples.
  template <class T>
  dds::Writer<T> writer(const std::string& topic, int depth) {
    dds::Writer<T> made(participant_, "rt/" + topic, depth, type_user_data<T>());
    add(made.get(), topic, dds::descriptor<T>(), true);
    return made;
  }
  /// A volatile reader of the newest `depth` samples. A best-effort reader matches every writer; a reliable one loses
  /// nothing, but does not match best-effort writers.
  template <class T>
  Subscription<T> reader(const std::string& topic, int depth, Reliability reliability) {
    Subscription<T> made(create_reader(dds::descriptor<T>(), topic, depth, reliability, type_user_data<T>()));
    add(made.get(), topic, dds::descriptor<T>(), false);
    return made;
  }
  /// Announces to ROS 2 that the readers and writers created until now belong to this node. Call this function after
  /// all of them have been created.
  void announce();

  [[nodiscard]] const std::vector<Topic>& topics() const { return topics_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void add(dds_entity_t entity, const std::string& topic, const dds_topic_descriptor_t& type, bool written);
  dds_entity_t create_reader(const dds_topic_descriptor_t& type, const std::string& topic, int depth,
                             Reliability reliability, const std::string& user_data) const;
  template <class Info, class Entities, class Gid>
  void publish(const dds_topic_descriptor_t& type);

  dds_entity_t participant_;
  std::string name_;
  Release release_;
  std::vector<Topic> topics_;
  std::vector<dds_guid_t> readers_, writers_;
  dds::Entity graph_;  ///< writer of ros_discovery_info, which keeps its sample for nodes that start later
};

/// "sensor_msgs::msg::dds_::JointState_" is "sensor_msgs/msg/JointState" in ROS 2's words.
[[nodiscard]] std::string ros_type_name(const std::string& dds_type);

}  // namespace constrictor::ros_bridge
