// The ROS 2 messages of topics: idlc's descriptors, for the typed readers and writers of cyclone/endpoint.hpp, and the
// type hashes that ROS 2 compares from Iron on.
#pragma once

#include <string>

#include "cyclone/endpoint.hpp"
#include "ros_types.h"

namespace constrictor::ros_bridge {

/// The type hash, as REP 2016 defines it: SHA-256 of names and types of all fields, in hexadecimal.
template <class T>
inline constexpr const char* kTypeHash = nullptr;

/// The user data of a reader or writer of T: ROS 2 takes the type hash from it.
template <class T>
std::string type_user_data() {
  return std::string("typehash=RIHS01_") + kTypeHash<T> + ";";
}

}  // namespace constrictor::ros_bridge

// The hashes are those that ROS 2's own generator writes for Jazzy and Rolling. The test computes each of them from
// ros_types.idl, so that a field in a wrong place is noticed.
#define CONSTRICTOR_ROS_TYPES(X)                                                                                   \
  X(rosgraph_msgs_msg_dds__Clock_, "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564")             \
  X(rcl_interfaces_msg_dds__Log_, "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac")              \
  X(sensor_msgs_msg_dds__JointState_, "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e")          \
  X(sensor_msgs_msg_dds__Imu_, "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b")                 \
  X(sensor_msgs_msg_dds__Image_, "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47")               \
  X(sensor_msgs_msg_dds__CameraInfo_, "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275")          \
  X(nav_msgs_msg_dds__Odometry_, "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0")               \
  X(nav_msgs_msg_dds__Path_, "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b")                   \
  X(tf2_msgs_msg_dds__TFMessage_, "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087")              \
  X(geometry_msgs_msg_dds__Twist_, "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a")             \
  X(visualization_msgs_msg_dds__MarkerArray_, "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf")  \
  X(diagnostic_msgs_msg_dds__DiagnosticArray_, "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e") \
  X(std_msgs_msg_dds__String_, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18")                 \
  X(std_msgs_msg_dds__Bool_, "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9")                   \
  X(std_msgs_msg_dds__Empty_, "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312")                  \
  X(rmw_dds_common_msg_dds__ParticipantEntitiesInfo_,                                                              \
    "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e")

#define CONSTRICTOR_ROS_TYPE(Type, Hash)                                      \
  template <>                                                                 \
  inline const dds_topic_descriptor_t& constrictor::dds::descriptor<Type>() { \
    return Type##_desc;                                                       \
  }                                                                           \
  template <>                                                                 \
  inline constexpr const char* constrictor::ros_bridge::kTypeHash<Type> = Hash;
CONSTRICTOR_ROS_TYPES(CONSTRICTOR_ROS_TYPE)
#undef CONSTRICTOR_ROS_TYPE
