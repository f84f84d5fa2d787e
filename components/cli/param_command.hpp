// `constrictor param`: list, get and set the parameters that a run's components let change while they run.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_param(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
