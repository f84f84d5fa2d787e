// Files of run-time parameters: what `param dump` writes and `param load` reads. Pure: no DDS.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/parameters.hpp"

namespace constrictor::cli {

/// A value of a file, for a parameter that may change and differs from the value in force.
struct ParameterValue {
  std::string name;  ///< "navigation.travel.speed_m_s"
  double value = 0;
  std::string text;  ///< the value as a person wrote it: a number or a name
};

/// The parameters as a YAML file that read_parameter_file() reads: one line for each, with unit, accepted values and
/// meaning as a comment. `title`: a line of text for its beginning. `changed`: only those that were changed, or that a
/// pending request changes.
[[nodiscard]] std::string parameter_file(const ParameterView& view, const std::string& title, bool changed);

/// Reads and checks a file. Keys may be whole names (`navigation.travel.speed_m_s: 0.9`) or nested, as in the
/// component's configuration file. `is_fixed(name)`: whether a key of this name is in the configuration of a component,
/// so that it is known but cannot change while the run goes on. Throws ConfigurationError that lists every mistake,
/// with file, line, key, what was found and what is accepted.
[[nodiscard]] std::vector<ParameterValue> read_parameter_file(const std::string& text, const std::string& file,
                                                              const ParameterView& view,
                                                              const std::function<bool(const std::string&)>& is_fixed);

/// Whether the default configuration of the component that the name begins with has this key.
[[nodiscard]] bool is_in_configuration(const std::string& name);

/// Why a parameter that is_in_configuration(), but that no component announces, is refused, and what to do.
[[nodiscard]] std::string why_fixed(const std::string& name);

}  // namespace constrictor::cli
