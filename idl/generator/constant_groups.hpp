// Groups of constants: kColourUnknown, kColourGreen... are the group kColour.
#pragma once

#include <string>
#include <vector>

#include "idl/generator/idl_parser.hpp"

namespace constrictor::generator {

/// Constants whose values count from 0 without gaps.
struct ConstantGroup {
  std::string prefix;              ///< "kColour"
  std::vector<std::string> names;  ///< by value, as people and files write them: "unknown", "green", ...
};

/// The group that the comment of an octet field names by "kColour...": its prefix; empty if it names none. Fields of
/// other types hold no constants, although their comments may refer to some.
std::string group_of(const Field& field);

/// The groups that the fields of `model` name, in the order of their constants. Throws std::runtime_error if a field
/// names a group without constants, if an octet constant belongs to no group, or if values have gaps.
std::vector<ConstantGroup> constant_groups(const Model& model);

}  // namespace constrictor::generator
