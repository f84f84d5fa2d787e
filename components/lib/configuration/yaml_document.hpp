// One YAML document of a text.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace constrictor {

/// Parses a text that is one YAML document. Throws YAML::ParserException, also for what yaml-cpp accepts but nobody can
/// mean: a second document, which would be ignored, and an alias to a value that contains it, through which every
/// function that visits all values would go round for ever.
[[nodiscard]] YAML::Node parse_yaml(const std::string& text);

/// "valid YAML", with a hint what may be missing if it is about lists or maps in brackets.
[[nodiscard]] std::string accepted_yaml(const YAML::Exception& error);

}  // namespace constrictor
