// Types as their writers describe them over DDS (XTypes type objects): with them, tools decode samples of types that
// they were not compiled with.
//
// Cyclone's dds_create_topic_descriptor() does not replace this. It fails (DDS_RETCODE_UNSUPPORTED, Cyclone DDS 0.10.2)
// for 9 of this project's 50 message types, all with a string as their key; the descriptors have no field names; and it
// needs a writer with type information.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "cyclone/discovery.hpp"

namespace constrictor::dds {

struct TypeNode;

/// A type in the language of ROS 2's message files.
struct Ros2Schema {
  std::string name;     ///< "constrictor/msg/JointState"; empty: the language cannot express the type
  std::string text;     ///< the fields of the type, then those of all structures that it contains
  std::string why_not;  ///< if the name is empty: "its type contains a union"
};

class TypeTree {
 public:
  /// Requests the descriptions of the endpoint's type and of all types that it contains. Null if the endpoint announces
  /// no type information, or if no answer comes within `bound`.
  static std::unique_ptr<TypeTree> find(dds_entity_t participant, const Endpoint& endpoint,
                                        std::chrono::milliseconds bound);
  /// The type of a topic in the table of topics, by its DDS name (`constrictor::msg::JointState`): for writers that
  /// announce no type information. Null if no topic has this type.
  static std::unique_ptr<TypeTree> known(dds_entity_t participant, const std::string& type);
  ~TypeTree();

  /// Decodes a sample (with its encapsulation header; XCDR1 or XCDR2, either byte order) to all of its fields in order.
  /// NaN and infinities become null. Throws std::runtime_error if the bytes are not one sample of this type.
  [[nodiscard]] nlohmann::ordered_json decode(std::span<const std::uint8_t> bytes) const;
  /// The type as IDL-like text.
  [[nodiscard]] std::string text() const;
  /// The type for recordings. Enumerations are integers, arrays have one dimension, names are in lower case.
  [[nodiscard]] Ros2Schema ros2_schema() const;

 private:
  explicit TypeTree(std::shared_ptr<const TypeNode> root);
  std::shared_ptr<const TypeNode> root_;
};

}  // namespace constrictor::dds
