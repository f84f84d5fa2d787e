// `constrictor param`: lists, prints and changes the parameters of a run while it runs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// Adds the subcommand; if it is chosen, `action` is set to a function that returns the exit status.
void add_param(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
