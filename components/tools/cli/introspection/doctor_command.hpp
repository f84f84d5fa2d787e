// `constrictor doctor`: finds faults that prevent processes from working together, and names the cure.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace constrictor::cli {

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_doctor(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
