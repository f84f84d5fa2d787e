// Definitions of ROS 2 messages, read from an IDL file of the bridge and from the .msg files of ROS, in one form.
#pragma once

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace constrictor::ros_bridge {

/// One field of a message, in the words of .msg files: "float64[36] covariance", "string<=256 node_name".
struct RosField {
  std::string type;  ///< uint8, string, geometry_msgs/Point ... without array and bound
  std::string name;
  enum class Count { kOne, kArray, kSequence } count = Count::kOne;
  std::size_t size = 0;   ///< of an array
  std::size_t bound = 0;  ///< of a string; 0: none
  bool operator==(const RosField&) const = default;
};

std::ostream& operator<<(std::ostream& stream, const RosField& field);

/// Fields by message: "sensor_msgs/Imu".
using RosDefinitions = std::map<std::string, std::vector<RosField>>;

/// The structs of an IDL file with modules PACKAGE::msg::dds_, in the form of ros_types.idl. Throws
/// std::invalid_argument on a line that it does not understand.
RosDefinitions read_ros_idl(const std::string& text);
/// The fields of a .msg file, constants left out. `package` completes type names without a package.
std::vector<RosField> read_ros_msg(const std::string& text, const std::string& package);
/// The type hash of ROS 2 (REP 2016, "RIHS01"), in hexadecimal and without prefix.
std::string ros_type_hash(const std::string& message, const RosDefinitions& definitions);

}  // namespace constrictor::ros_bridge
