#define DDS_HAS_TYPE_DISCOVERY 1  // the Debian library is built with it; its headers expect their user to define it
#include "cyclone/type_resolver.hpp"

#include <dds/ddsi/ddsi_xqos.h>

// After ddsi_xqos.h, whose types they use without including it.
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_typewrap.h>
#include <dds/ddsi/ddsi_xt_impl.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cyclone/type_node.hpp"

namespace constrictor::dds {
namespace {

using Kind = TypeNode::Kind;
using Identifier = DDS_XTypes_TypeIdentifier;
using NodePtr = std::shared_ptr<const TypeNode>;

/// A description that no process sends, or that this project does not decode.
class Unknown : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::uint8_t holder(std::uint16_t bits, bool is_signed) {
  if (bits <= 8) return DDS_XTypes_TK_BYTE;
  if (bits <= 16) return is_signed ? DDS_XTypes_TK_INT16 : DDS_XTypes_TK_UINT16;
  return bits <= 32 ? (is_signed ? DDS_XTypes_TK_INT32 : DDS_XTypes_TK_UINT32) : DDS_XTypes_TK_UINT64;
}

TypeNode::Extensibility extensibility(std::uint16_t flags) {
  if (flags & DDS_XTypes_IS_MUTABLE) return TypeNode::Extensibility::kMutable;
  return flags & DDS_XTypes_IS_APPENDABLE ? TypeNode::Extensibility::kAppendable : TypeNode::Extensibility::kFinal;
}

/// Converts type identifiers to nodes. Requests the type objects from the participants that announced them.
class Resolver {
 public:
  Resolver(dds_entity_t participant, std::chrono::milliseconds bound)
      : participant_(participant), end_(std::chrono::steady_clock::now() + bound) {}

  NodePtr node(const Identifier& id) {
    auto node = std::make_shared<TypeNode>();
    switch (id._d) {
      case DDS_XTypes_TI_STRING8_SMALL:
      case DDS_XTypes_TI_STRING8_LARGE:
        node->kind = Kind::kString;
        node->most = id._d == DDS_XTypes_TI_STRING8_SMALL ? id._u.string_sdefn.bound : id._u.string_ldefn.bound;
        return node;
      case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL:
        return sequence(*id._u.seq_sdefn.element_identifier, id._u.seq_sdefn.bound);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_LARGE:
        return sequence(*id._u.seq_ldefn.element_identifier, id._u.seq_ldefn.bound);
      case DDS_XTypes_TI_PLAIN_ARRAY_SMALL: {
        const auto& bounds = id._u.array_sdefn.array_bound_seq;
        return array(*id._u.array_sdefn.element_identifier, {bounds._buffer, bounds._buffer + bounds._length});
      }
      case DDS_XTypes_TI_PLAIN_ARRAY_LARGE: {
        const auto& bounds = id._u.array_ldefn.array_bound_seq;
        return array(*id._u.array_ldefn.element_identifier, {bounds._buffer, bounds._buffer + bounds._length});
      }
      case DDS_XTypes_EK_COMPLETE:
        return described(id);
      default:
        break;
    }
    if (id._d >= DDS_XTypes_TK_BOOLEAN && id._d <= DDS_XTypes_TK_CHAR8 && id._d != DDS_XTypes_TK_FLOAT128) {
      node->primitive = id._d;
      return node;
    }
    throw Unknown(fmt::format("type identifier {} is not decoded", id._d));
  }

 private:
  NodePtr sequence(const Identifier& element, std::uint32_t most) {
    auto made = std::make_shared<TypeNode>();
    made->kind = Kind::kSequence;
    made->most = most;
    made->element = node(element);
    return made;
  }
  NodePtr array(const Identifier& element, std::vector<std::uint32_t> bounds) {
    auto made = std::make_shared<TypeNode>();
    made->kind = Kind::kArray;
    made->element = node(element);
    made->bounds = std::move(bounds);
    return made;
  }

  NodePtr described(const Identifier& id) {
    const std::string hash(reinterpret_cast<const char*>(id._u.equivalence_hash), sizeof id._u.equivalence_hash);
    const auto known = known_.find(hash);
    if (known != known_.end()) return known->second;
    if (!begun_.insert(hash).second) throw Unknown("types that contain themselves are not decoded");
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(end_ - std::chrono::steady_clock::now()).count();
    dds_typeobj_t* object = nullptr;
    ddsi_typeid_t type_id{id};
    if (dds_get_typeobj(participant_, &type_id, std::max<dds_duration_t>(left, DDS_MSECS(1)), &object) !=
            DDS_RETCODE_OK ||
        !object) {
      throw Unknown("no process describes the type");
    }
    const std::unique_ptr<dds_typeobj_t, void (*)(dds_typeobj_t*)> owned(
        object, [](dds_typeobj_t* own) { dds_free_typeobj(own); });
    if (object->x._d != DDS_XTypes_EK_COMPLETE) throw Unknown("the type is described without names");
    return known_[hash] = convert(object->x._u.complete);
  }

  NodePtr convert(const DDS_XTypes_CompleteTypeObject& object) {
    auto made = std::make_shared<TypeNode>();
    switch (object._d) {
      case DDS_XTypes_TK_ALIAS:
        return node(object._u.alias_type.body.common.related_type);
      case DDS_XTypes_TK_STRUCTURE:
        structure(object._u.struct_type, *made);
        return made;
      case DDS_XTypes_TK_UNION:
        union_(object._u.union_type, *made);
        return made;
      case DDS_XTypes_TK_SEQUENCE:
        return sequence(object._u.sequence_type.element.common.type, object._u.sequence_type.header.common.bound);
      case DDS_XTypes_TK_ARRAY: {
        const auto& bounds = object._u.array_type.header.common.bound_seq;
        return array(object._u.array_type.element.common.type, {bounds._buffer, bounds._buffer + bounds._length});
      }
      case DDS_XTypes_TK_ENUM: {
        const auto& type = object._u.enumerated_type;
        made->kind = Kind::kEnum;
        made->name = type.header.detail.type_name;
        made->primitive = holder(type.header.common.bit_bound, true);
        for (std::uint32_t i = 0; i < type.literal_seq._length; ++i) {
          made->literals[type.literal_seq._buffer[i].common.value] = type.literal_seq._buffer[i].detail.name;
        }
        return made;
      }
      case DDS_XTypes_TK_BITMASK: {
        const auto& type = object._u.bitmask_type;
        made->kind = Kind::kBitmask;
        made->name = type.header.detail.type_name;
        made->primitive = holder(type.header.common.bit_bound, false);
        return made;
      }
      default:
        throw Unknown(fmt::format("type kind {} is not decoded", object._d));
    }
  }

  void structure(const DDS_XTypes_CompleteStructType& type, TypeNode& made) {
    made.kind = Kind::kStruct;
    made.name = type.header.detail.type_name;
    made.extensibility = extensibility(type.struct_flags);
    if (type.header.base_type._d != DDS_XTypes_TK_NONE) made.members = node(type.header.base_type)->members;
    for (std::uint32_t i = 0; i < type.member_seq._length; ++i) {
      const auto& member = type.member_seq._buffer[i];
      made.members.push_back({member.detail.name,
                              member.common.member_id,
                              (member.common.member_flags & DDS_XTypes_IS_OPTIONAL) != 0,
                              false,
                              {},
                              node(member.common.member_type_id)});
    }
  }

  void union_(const DDS_XTypes_CompleteUnionType& type, TypeNode& made) {
    made.kind = Kind::kUnion;
    made.name = type.header.detail.type_name;
    made.extensibility = extensibility(type.union_flags);
    made.element = node(type.discriminator.common.type_id);
    for (std::uint32_t i = 0; i < type.member_seq._length; ++i) {
      const auto& member = type.member_seq._buffer[i];
      const auto& labels = member.common.label_seq;
      made.members.push_back({member.detail.name,
                              member.common.member_id,
                              false,
                              (member.common.member_flags & DDS_XTypes_IS_DEFAULT) != 0,
                              {labels._buffer, labels._buffer + labels._length},
                              node(member.common.type_id)});
    }
  }

  dds_entity_t participant_;
  std::chrono::steady_clock::time_point end_;
  std::map<std::string, NodePtr> known_;
  std::set<std::string> begun_;
};

}  // namespace

NodePtr resolve_type(dds_entity_t participant, const ddsi_typeid& id, std::chrono::milliseconds bound) {
  try {
    return Resolver(participant, bound).node(id.x);
  } catch (const Unknown&) {
    return nullptr;
  }
}

}  // namespace constrictor::dds
