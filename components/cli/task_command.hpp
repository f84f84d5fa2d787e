// `constrictor task`: start, cancel and wait for the paper's tasks from a script.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace constrictor::cli {

void add_task(CLI::App& app, std::function<int()>& action);

/// "5s", "500ms", "2m" or plain seconds. Throws UsageError naming `option` otherwise, or if it is not positive.
std::chrono::milliseconds parse_duration(const std::string& option, const std::string& text);

}  // namespace constrictor::cli
