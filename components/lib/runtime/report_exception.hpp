// What a program does with an exception that ends it.
#pragma once

#include <string>

namespace constrictor {

/// For a `catch (...)` in main(): prints the exception as "PROGRAM: ..." on standard error and returns the exit status
/// of the program, kConfiguration for a ConfigurationError and kSoftware for every other std::exception.
[[nodiscard]] int report_exception(const std::string& program);

}  // namespace constrictor
