// `constrictor node`: the processes of a domain.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_node(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
