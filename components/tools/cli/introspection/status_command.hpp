// `constrictor status`: the runs of this host, and a live table of one's components.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_status(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
