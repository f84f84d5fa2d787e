// idlc's descriptors of the ROS 2 messages, for the typed readers and writers of cyclone/endpoint.hpp.
#pragma once

#include "cyclone/endpoint.hpp"
#include "ros_types.h"

namespace constrictor::dds {

#define CONSTRICTOR_ROS_DESCRIPTOR(Type)                    \
  template <>                                               \
  inline const dds_topic_descriptor_t& descriptor<Type>() { \
    return Type##_desc;                                     \
  }
CONSTRICTOR_ROS_DESCRIPTOR(rosgraph_msgs_msg_dds__Clock_)
CONSTRICTOR_ROS_DESCRIPTOR(sensor_msgs_msg_dds__JointState_)
CONSTRICTOR_ROS_DESCRIPTOR(sensor_msgs_msg_dds__Imu_)
CONSTRICTOR_ROS_DESCRIPTOR(sensor_msgs_msg_dds__Image_)
CONSTRICTOR_ROS_DESCRIPTOR(sensor_msgs_msg_dds__CameraInfo_)
CONSTRICTOR_ROS_DESCRIPTOR(nav_msgs_msg_dds__Odometry_)
CONSTRICTOR_ROS_DESCRIPTOR(tf2_msgs_msg_dds__TFMessage_)
CONSTRICTOR_ROS_DESCRIPTOR(geometry_msgs_msg_dds__Twist_)
#undef CONSTRICTOR_ROS_DESCRIPTOR

}  // namespace constrictor::dds
