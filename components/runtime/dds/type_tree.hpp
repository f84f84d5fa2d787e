// Types as their writers describe them over DDS (XTypes type objects), and decoding of samples by them: how tools read topics
// of types that they were never compiled with.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "runtime/dds/discovery.hpp"

namespace constrictor::dds {

struct TypeNode;

class TypeTree {
 public:
  /// Asks for the description of the endpoint's type and of everything it is made of. Null if the endpoint announces none, or
  /// nobody answers within `bound`.
  static std::unique_ptr<TypeTree> find(dds_entity_t participant, const Endpoint& endpoint, std::chrono::milliseconds bound);
  ~TypeTree();

  /// A sample (encapsulation header included, XCDR1 or XCDR2, either byte order) with all of its fields in order. NaN and
  /// infinities are null. Throws std::runtime_error if the bytes are not one sample of this type.
  [[nodiscard]] nlohmann::ordered_json decode(std::span<const std::uint8_t> bytes) const;
  /// The type as IDL-like text.
  [[nodiscard]] std::string text() const;

 private:
  explicit TypeTree(std::shared_ptr<const TypeNode> root);
  std::shared_ptr<const TypeNode> root_;
};

}  // namespace constrictor::dds
