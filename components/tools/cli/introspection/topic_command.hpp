// `constrictor topic`: list, info, echo, hz and delay of any topic on a domain, also of types this project does not
// define.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_topic(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
