// What every subcommand has in common: wrong usage, whole numbers, and the end of its --help.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
class Validator;
}

namespace constrictor::cli {

/// A value on the command line that makes no sense: exit status 64. The message names the option, what was found and what is accepted.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Refuses what is no whole number from 0 on: "-1" would otherwise be a very large one.
CLI::Validator whole_number();

/// Adds --run: the run, by its DDS domain, also by CONSTRICTOR_DOMAIN.
void add_run_option(CLI::App& app, std::optional<std::uint32_t>& domain);

/// The end of a --help: what is good to know, EXAMPLES one a line, EXIT STATUS, and the ENVIRONMENT that all commands to a run heed.
std::string help_footer(const std::string& about, std::initializer_list<const char*> examples, const std::string& exit_status);

/// Exit statuses of every command that looks for a run, after its own.
inline constexpr const char* kRunStatuses = "64 wrong usage; 70 no run, or several and none chosen";

}  // namespace constrictor::cli
