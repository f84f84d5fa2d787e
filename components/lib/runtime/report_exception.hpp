// What a program does with an exception that ends it.
#pragma once

#include <string>

namespace constrictor {

/// Prints a line on standard error. A line that cannot be written is lost: it must not end the program otherwise than
/// its exit status says.
void say_error(const std::string& line) noexcept;

/// For a `catch (...)` in main(): prints the exception as "PROGRAM: ..." on standard error and returns the exit status
/// of the program, kConfiguration for a ConfigurationError and kSoftware for every other std::exception.
[[nodiscard]] int report_exception(const std::string& program);

}  // namespace constrictor
