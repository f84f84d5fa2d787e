// The common parts of all subcommands: errors of usage, common options, and the last part of --help.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>

#include "configuration/command_line.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace constrictor::cli {

/// An invalid value on the command line: exit status 64. The message names the option, what was found and what is
/// accepted.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Adds --run: the DDS domain of a run, also read from CONSTRICTOR_DOMAIN; and --token-file.
void add_run_option(CLI::App& app, std::optional<std::uint32_t>& domain);
/// Adds --token-file, from which clients in this process take the token (run_key()).
void add_token_option(CLI::App& app);

/// The ENVIRONMENT of the commands that join a run, for help_footer().
inline constexpr const char* kRunEnvironment =
    "CONSTRICTOR_DOMAIN  the run, like --run\n"
    "  CYCLONEDDS_URI      DDS configuration, needed to reach other hosts (deploy/cyclonedds)";

/// The ENVIRONMENT of the commands that only read files.
inline constexpr const char* kDataEnvironment =
    "CONSTRICTOR_DATA   directory of the default files, instead of the source tree or the install prefix";

/// The last part of a --help: remarks, EXAMPLES (one per line), EXIT STATUS and ENVIRONMENT. If `exit_status` or
/// `environment` has several lines, the caller begins the second and each further one with two spaces. The lines of
/// `about` are not indented.
std::string help_footer(const std::string& about, std::initializer_list<const char*> examples,
                        const std::string& exit_status, const std::string& environment = kRunEnvironment);

/// Text for help_footer(): the exit statuses of all commands that look for a run.
inline constexpr const char* kRunStatuses = "64 wrong usage; 70 no run, or several and none chosen";

}  // namespace constrictor::cli
