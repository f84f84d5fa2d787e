// A type as its writer describes it, and the decoding of samples by it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace constrictor::dds {

struct TypeNode {
  enum class Kind { kPrimitive, kString, kEnum, kBitmask, kSequence, kArray, kStruct, kUnion };
  enum class Extensibility { kFinal, kAppendable, kMutable };
  struct Member {
    std::string name;
    std::uint32_t id = 0;
    bool optional = false;
    bool is_default = false;           ///< of a union
    std::vector<std::int32_t> labels;  ///< of a union
    std::shared_ptr<const TypeNode> type;
  };

  Kind kind = Kind::kPrimitive;
  std::uint8_t primitive = 0;  ///< DDS_XTypes_TK_...; of enumerations and bit masks: that of their integer
  std::string name;
  Extensibility extensibility = Extensibility::kFinal;
  std::vector<Member> members;              ///< of structures (those of the base first) and unions
  std::shared_ptr<const TypeNode> element;  ///< of collections; of unions: the discriminator
  std::vector<std::uint32_t> bounds;        ///< of arrays: their dimensions
  std::uint32_t most = 0;                   ///< of texts and sequences: the largest length; 0: without a limit
  std::map<std::int64_t, std::string> literals;

  /// XCDR2 puts the size of a collection before it, unless its elements are primitive.
  [[nodiscard]] bool is_primitive() const { return kind == Kind::kPrimitive; }
};

/// Decodes one sample, as TypeTree::decode() does. Throws std::runtime_error if the bytes are not one sample of `type`.
nlohmann::ordered_json decode(const TypeNode& type, std::span<const std::uint8_t> bytes);

/// Encodes a sample, as TypeTree::encode() does. Throws std::invalid_argument.
std::vector<std::uint8_t> encode(const TypeNode& type, const nlohmann::ordered_json& value);

}  // namespace constrictor::dds
