// Samples of the project's own types: constants by name, and for people arrays without their unused tail.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace constrictor::cli {

/// kUsed: an array whose length is in a field ..._count before it loses the elements after that length. kWhole: every
/// array keeps its length, which scripts may rely on.
enum class Arrays { kUsed, kWhole };

/// Changes a decoded sample of the IDL type `type` ("constrictor::msg::TaskStatus"): a field that holds a constant gets
/// the constant's name, and arrays are shortened according to `arrays`. A sample of a type that the project does not
/// define, or that does not fit its type, stays as it is.
void make_readable(nlohmann::ordered_json& sample, const std::string& type, Arrays arrays);

/// For people: adds to each id of a goal the number by which the commands name the goal, "844424930131970, goal 2". The
/// sample, or a part of it, must be one of the project's own types.
void name_goals(nlohmann::ordered_json& sample);

}  // namespace constrictor::cli
