// The definitions of ROS 2 messages in ros_types.idl, against the type hashes that ROS 2 announces and against the
// .msg files of Debian's packages ros-*-msgs.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "component/data_path.hpp"
#include "ros_bridge/ros_descriptors.hpp"
#include "unit/ros_bridge/ros_definitions.hpp"

namespace constrictor::ros_bridge {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

RosDefinitions definitions() { return read_ros_idl(read(data_path("components/tools/ros_bridge/ros_types.idl"))); }

/// Announced types: DDS name and hash.
std::map<std::string, std::string> announced() {
  std::map<std::string, std::string> hashes;
#define CONSTRICTOR_ROS_HASH(Type, Hash) hashes[Type##_desc.m_typename] = Hash;
  CONSTRICTOR_ROS_TYPES(CONSTRICTOR_ROS_HASH)
#undef CONSTRICTOR_ROS_HASH
  return hashes;
}

std::string message_of(std::string dds_name) {
  dds_name.erase(dds_name.size() - 1);
  return dds_name.replace(dds_name.find("::msg::dds_::"), 13, "/");
}

TEST(RosTypes, HaveTheHashesThatRosAnnounces) {
  const RosDefinitions ours = definitions();
  for (const auto& [dds_name, hash] : announced()) {
    ASSERT_TRUE(ours.contains(message_of(dds_name))) << dds_name;
    EXPECT_EQ(ros_type_hash(message_of(dds_name), ours), hash) << dds_name;
  }
}

TEST(RosTypes, EachMistakeInADefinitionChangesTheHash) {
  // Otherwise HaveTheHashesThatRosAnnounces could not fail.
  const RosDefinitions ours = definitions();
  const std::string name = "diagnostic_msgs/DiagnosticArray";
  const std::string right = ros_type_hash(name, ours);
  const auto hash_with = [&](auto&& change) {
    RosDefinitions wrong = ours;
    change(wrong);
    return ros_type_hash(name, wrong);
  };
  const char* part = "diagnostic_msgs/DiagnosticStatus";
  EXPECT_NE(hash_with([&](auto& wrong) { std::swap(wrong.at(part)[1], wrong.at(part)[2]); }), right);
  EXPECT_NE(hash_with([&](auto& wrong) { wrong.at(part)[0].type = "uint8"; }), right);
  EXPECT_NE(hash_with([&](auto& wrong) { wrong.at(part)[1].name = "nam"; }), right);
  EXPECT_NE(hash_with([&](auto& wrong) { wrong.at(part)[4].count = RosField::Count::kOne; }), right);
  EXPECT_NE(hash_with([&](auto& wrong) { wrong.at(name)[0].type = "std_msgs/String"; }), right);
}

/// What ROS 2 changed. Source of the expected form: the .msg files of ROS 2 (github.com/ros2/common_interfaces and
/// rcl_interfaces, branches humble to rolling), the ROS 2 migration guide.
struct Difference {
  std::string message;
  std::string reason;
  std::vector<RosField> ros1, ros2;  ///< these fields of ROS 1, in one piece, became those of ROS 2
};

RosField field(const std::string& type, const std::string& name) { return {type, name}; }

std::vector<Difference> differences() {
  constexpr auto kSequence = RosField::Count::kSequence;
  constexpr auto kArray = RosField::Count::kArray;
  return {
      {"std_msgs/Header", "ROS 2 counts no headers", {field("uint32", "seq")}, {}},
      {"std_msgs/Empty", "DDS has no empty structs", {}, {field("uint8", "structure_needs_at_least_one_member")}},
      {"sensor_msgs/CameraInfo",
       "names of fields are in lower case",
       {{"float64", "D", kSequence},
        {"float64", "K", kArray, 9},
        {"float64", "R", kArray, 9},
        {"float64", "P", kArray, 12}},
       {{"float64", "d", kSequence},
        {"float64", "k", kArray, 9},
        {"float64", "r", kArray, 9},
        {"float64", "p", kArray, 12}}},
      {"visualization_msgs/Marker",
       "textures, and meshes inside the message",
       {field("string", "text"), field("string", "mesh_resource"), field("bool", "mesh_use_embedded_materials")},
       {field("string", "texture_resource"),
        field("sensor_msgs/CompressedImage", "texture"),
        {"visualization_msgs/UVCoordinate", "uv_coordinates", kSequence},
        field("string", "text"),
        field("string", "mesh_resource"),
        field("visualization_msgs/MeshFile", "mesh_file"),
        field("bool", "mesh_use_embedded_materials")}},
  };
}

/// Messages that ROS 1 does not have. `time` and `duration` were basic types of its .msg files.
const std::set<std::string> kOnlyRos2 = {"rcl_interfaces/Log",
                                         "builtin_interfaces/Time",
                                         "builtin_interfaces/Duration",
                                         "visualization_msgs/UVCoordinate",
                                         "visualization_msgs/MeshFile",
                                         "rmw_dds_common/Gid",
                                         "rmw_dds_common/HumbleGid",
                                         "rmw_dds_common/NodeEntitiesInfo",
                                         "rmw_dds_common/HumbleNodeEntitiesInfo",
                                         "rmw_dds_common/ParticipantEntitiesInfo",
                                         "rmw_dds_common/HumbleParticipantEntitiesInfo"};

TEST(RosTypes, AgreeWithDebiansDefinitionsExceptWhereRos2Changed) {
  const RosDefinitions ours = definitions();
  auto changes = differences();
  int compared = 0;
  for (const auto& [message, fields] : ours) {
    if (kOnlyRos2.contains(message)) continue;
    const auto slash = message.find('/');
    const std::string package = message.substr(0, slash);
    const std::filesystem::path file = "/usr/share/" + package + "/msg/" + message.substr(slash + 1) + ".msg";
    ASSERT_TRUE(std::filesystem::exists(file)) << file << ": install Debian's packages with scripts/setup.sh tests";
    auto expected = read_ros_msg(read(file), package);
    for (RosField& one : expected) {
      if (one.type == "time") one.type = "builtin_interfaces/Time";
      if (one.type == "duration") one.type = "builtin_interfaces/Duration";
    }
    const auto change = std::find_if(changes.begin(), changes.end(),
                                     [&name = message](const auto& each) { return each.message == name; });
    if (change != changes.end()) {
      const auto at = std::search(expected.begin(), expected.end(), change->ros1.begin(), change->ros1.end());
      ASSERT_TRUE(at != expected.end() || expected.empty()) << message << " of ROS 1 is not as expected";
      const auto rest = expected.erase(at, at + static_cast<std::ptrdiff_t>(change->ros1.size()));
      expected.insert(rest, change->ros2.begin(), change->ros2.end());
      changes.erase(change);
    }
    EXPECT_EQ(fields, expected) << message;
    ++compared;
  }
  EXPECT_TRUE(changes.empty()) << changes.front().message << " is not in ros_types.idl";
  EXPECT_GE(compared, 25);
}

TEST(RosTypes, HumblesGraphMessagesDifferInTheLengthOfTheIdsOnly) {
  RosDefinitions ours = definitions();
  EXPECT_EQ(ours.at("rmw_dds_common/Gid").at(0).size, 16u);
  EXPECT_EQ(ours.at("rmw_dds_common/HumbleGid").at(0).size, 24u);
  for (const std::string name : {"NodeEntitiesInfo", "ParticipantEntitiesInfo"}) {
    auto humble = ours.at("rmw_dds_common/Humble" + name);
    for (RosField& one : humble) {
      if (const auto at = one.type.find("Humble"); at != std::string::npos) one.type.erase(at, 6);
    }
    EXPECT_EQ(humble, ours.at("rmw_dds_common/" + name));
  }
}

}  // namespace
}  // namespace constrictor::ros_bridge
