// `constrictor task`: start, cancel and wait for tasks from scripts.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Adds the subcommand; a chosen one stores in `action` what is to be done. It returns an exit status.
void add_task(CLI::App& app, std::function<int()>& action);

/// A duration such as "5s", "500ms", "2m"; a bare number is in seconds. Throws UsageError, naming `option`.
std::chrono::milliseconds parse_duration(const std::string& option, const std::string& text);

}  // namespace constrictor::cli
