// `constrictor task`: start, cancel and wait for tasks from scripts.
#pragma once

#include <chrono>
#include <string>

namespace constrictor::cli {

/// A duration such as "5s", "500ms", "2m"; a bare number is in seconds. Throws UsageError, naming `option`.
std::chrono::milliseconds parse_duration(const std::string& option, const std::string& text);

}  // namespace constrictor::cli
