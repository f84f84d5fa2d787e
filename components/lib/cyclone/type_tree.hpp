// Types as their writers describe them over DDS (XTypes type objects): with them, tools decode samples of types that
// they were not compiled with.
//
// Cyclone's dds_create_topic_descriptor() does not replace this. It fails (DDS_RETCODE_UNSUPPORTED, Cyclone DDS 0.10.2)
// for message types with a string as their key; the descriptors have no field names; and it needs a writer with type
// information.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "cyclone/discovery.hpp"

namespace constrictor::dds {

struct TypeNode;
class SampleVisitor;

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
  /// The same, but passes each value on, and NaN and infinities as they are.
  void decode(std::span<const std::uint8_t> bytes, SampleVisitor& visitor) const;
  /// The bytes of a sample in XCDR1, little-endian, with their encapsulation header. Fields that `value` leaves out are
  /// 0, false or empty. Accepted are numbers, texts and lists as decode() makes them, null for NaN, binary values for
  /// bytes, and names for enumerations. Of this project's types, also names of constants ("blue"), and lists that are
  /// shorter than their array, whose length goes to the field ..._count if `value` leaves that out; and what the IDL
  /// does not accept is refused (ranges, NaN). Throws std::invalid_argument that names the field, what was found and
  /// what is accepted.
  [[nodiscard]] std::vector<std::uint8_t> encode(const nlohmann::ordered_json& value) const;
  /// The type itself.
  [[nodiscard]] const TypeNode& root() const { return *root_; }
  /// The type as IDL-like text.
  [[nodiscard]] std::string text() const;
  /// The type for recordings. Enumerations are integers, arrays have one dimension, names are in lower case.
  [[nodiscard]] Ros2Schema ros2_schema() const;

 private:
  explicit TypeTree(std::shared_ptr<const TypeNode> root);
  /// `type_info`: a dds_typeinfo_t of a type to which a topic of this process refers.
  static std::unique_ptr<TypeTree> resolve(dds_entity_t participant, const void* type_info,
                                           std::chrono::milliseconds bound);
  std::shared_ptr<const TypeNode> root_;
};

}  // namespace constrictor::dds
