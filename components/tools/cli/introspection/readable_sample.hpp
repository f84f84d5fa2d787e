// Samples of the project's own types for people: constants by name, arrays without their unused tail.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace constrictor::cli {

/// Changes a decoded sample of the IDL type `type` ("constrictor::msg::TaskStatus"): a field that holds a constant gets
/// the constant's name, and an array whose length is in a field ..._count before it loses the elements after that
/// length. A sample of a type that the project does not define, or that does not fit its type, stays as it is.
void make_readable(nlohmann::ordered_json& sample, const std::string& type);

}  // namespace constrictor::cli
