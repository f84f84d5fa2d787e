// The command line of a program: what its options accept, and what it says about a wrong one.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
class Validator;
}  // namespace CLI

namespace constrictor {

/// Accepts only decimal digits that make a number from `min` to `max`. CLI11 alone would read "-1" as a very large
/// number and replace a number above 2^64 - 1 by 2^64 - 1.
CLI::Validator whole_number(std::uint64_t min = 0, std::uint64_t max = std::numeric_limits<std::uint64_t>::max());

/// Accepts only finite numbers from `min` to `max`; `unit`, for example "s", is shown in the error message.
CLI::Validator number(double min, double max, const std::string& unit);

/// Accepts only these words, and suggests the closest one.
CLI::Validator one_of(std::vector<std::string> words);

/// Accept only the path of a file, a folder, or either of them, that exists.
CLI::Validator existing_file();
CLI::Validator existing_folder();
CLI::Validator existing_path();

/// The error message for a command line that `app` could not parse, with the closest name for a mistyped subcommand or
/// option.
std::string explain_parse_error(const CLI::App& app, const CLI::ParseError& error);

/// Parses the command line of a program without actions of its own. Returns the status with which the program must
/// exit: 0 after --help and --version, 64 after a wrong command line, which is explained on stderr. Empty: go on.
[[nodiscard]] std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

}  // namespace constrictor
