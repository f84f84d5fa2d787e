#define DDS_HAS_TYPE_DISCOVERY 1  // the Debian library is built with it; its headers expect their user to define it
#include "cyclone/type_tree.hpp"

#include <dds/ddsi/ddsi_xqos.h>

// After ddsi_xqos.h, whose types they use without including it.
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_xt_impl.h>
#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "constrictor/descriptors.hpp"
#include "cyclone/raw_type.hpp"
#include "cyclone/type_node.hpp"
#include "cyclone/type_resolver.hpp"

namespace constrictor::dds {
namespace {

using Kind = TypeNode::Kind;

const char* primitive_name(std::uint8_t kind) {
  switch (kind) {
    case DDS_XTypes_TK_BOOLEAN:
      return "boolean";
    case DDS_XTypes_TK_BYTE:
      return "octet";
    case DDS_XTypes_TK_INT16:
      return "short";
    case DDS_XTypes_TK_INT32:
      return "long";
    case DDS_XTypes_TK_INT64:
      return "long long";
    case DDS_XTypes_TK_UINT16:
      return "unsigned short";
    case DDS_XTypes_TK_UINT32:
      return "unsigned long";
    case DDS_XTypes_TK_UINT64:
      return "unsigned long long";
    case DDS_XTypes_TK_FLOAT32:
      return "float";
    case DDS_XTypes_TK_FLOAT64:
      return "double";
    default:
      return "char";
  }
}

void describe_type(const TypeNode& type, int depth, std::string& text);

std::string name_of(const TypeNode& type) {
  switch (type.kind) {
    case Kind::kPrimitive:
      return primitive_name(type.primitive);
    case Kind::kString:
      return "string";
    case Kind::kSequence:
      return "sequence<" + name_of(*type.element) + ">";
    case Kind::kArray:
      return fmt::format("{}[{}]", name_of(*type.element), fmt::join(type.bounds, "]["));
    default:
      return type.name;
  }
}

/// The named structure inside collections, if there is one.
const TypeNode& inner(const TypeNode& type) {
  return (type.kind == Kind::kSequence || type.kind == Kind::kArray) ? inner(*type.element) : type;
}

void describe_type(const TypeNode& type, int depth, std::string& text) {
  for (const auto& member : type.members) {
    text += std::string(static_cast<std::size_t>(2 * depth), ' ') + name_of(*member.type) + " " + member.name + "\n";
    const TypeNode& part = inner(*member.type);
    if (part.kind == Kind::kStruct || part.kind == Kind::kUnion) describe_type(part, depth + 1, text);
  }
}

/// A name for a topic that no other process learns of, because it has no reader and no writer. Cyclone DDS refuses two
/// types for one name in a process.
std::string topic_name(const char* purpose) {
  static std::atomic<unsigned> count{0};
  return fmt::format("constrictor/{}/{}", purpose, ++count);
}

/// The identifier of the type's complete description; null if there is none.
const ddsi_typeid_t* complete_id(const void* type_info) {
  if (type_info == nullptr) return nullptr;
  const ddsi_typeid_t* id = ddsi_typeinfo_complete_typeid(static_cast<const ddsi_typeinfo_t*>(type_info));
  return id == nullptr || ddsi_typeid_is_none(id) ? nullptr : id;
}

/// A type of the table of topics. Cyclone DDS knows it as long as the topic exists.
struct OwnType {
  Entity topic;
  std::shared_ptr<const void> type_info;  ///< dds_typeinfo_t
};

std::optional<OwnType> own_type(dds_entity_t participant, const std::string& type) {
  static const std::map<std::string, const dds_topic_descriptor_t*> descriptors = {
#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, ...) {descriptor<msg::Type>().m_typename, &descriptor<msg::Type>()},
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, ...) {descriptor<msg::Type>().m_typename, &descriptor<msg::Type>()},
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
#undef CONSTRICTOR_UNCOUNTED_TOPIC
  };
  const auto found = descriptors.find(type);
  if (found == descriptors.end()) return std::nullopt;
  Entity topic(dds_create_topic(participant, found->second, topic_name("known_type").c_str(), nullptr, nullptr),
               "dds_create_topic");
  dds_typeinfo_t* info = nullptr;
  check(dds_get_typeinfo(topic.get(), &info), "dds_get_typeinfo");
  std::shared_ptr<const void> owned(
      info, [](const void* mine) { dds_free_typeinfo(static_cast<dds_typeinfo_t*>(const_cast<void*>(mine))); });
  return OwnType{std::move(topic), std::move(owned)};
}

}  // namespace

TypeTree::TypeTree(std::shared_ptr<const TypeNode> root) : root_(std::move(root)) {}
TypeTree::~TypeTree() = default;

std::unique_ptr<TypeTree> TypeTree::resolve(dds_entity_t participant, const void* type_info,
                                            std::chrono::milliseconds bound) {
  const ddsi_typeid_t* id = complete_id(type_info);
  auto root = id == nullptr ? nullptr : resolve_type(participant, *id, bound);
  return root == nullptr ? nullptr : std::unique_ptr<TypeTree>(new TypeTree(std::move(root)));
}

std::unique_ptr<TypeTree> TypeTree::find(dds_entity_t participant, const Endpoint& endpoint,
                                         std::chrono::milliseconds bound) {
  const ddsi_typeid_t* id = complete_id(endpoint.type_info.get());
  if (id == nullptr) return nullptr;
  if (const auto own = own_type(participant, endpoint.type);
      own && ddsi_typeid_compare(complete_id(own->type_info.get()), id) == 0)
    return resolve(participant, own->type_info.get(), bound);
  // dds_get_typeobj() of Cyclone DDS 0.10.2 keeps a pointer to the type while it waits, but no reference to it: if the
  // last process that uses the type ends meanwhile, it reads freed memory, and may abort. This topic is a reference.
  const RawTopic reference =
      create_described_topic(participant, topic_name("asked_type"), endpoint.type, endpoint.type_info);
  return resolve(participant, endpoint.type_info.get(), bound);
}

std::unique_ptr<TypeTree> TypeTree::known(dds_entity_t participant, const std::string& type) {
  const auto own = own_type(participant, type);
  return own ? resolve(participant, own->type_info.get(), std::chrono::seconds(1)) : nullptr;
}

std::string TypeTree::text() const {
  std::string text;
  describe_type(*root_, 0, text);
  return text;
}

}  // namespace constrictor::dds
