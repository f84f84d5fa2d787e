// The command `constrictor`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "runtime/git_revision.hpp"
#include "runtime/host.hpp"
#include "runtime/report_exception.hpp"
#include "runtime/version.hpp"
#include "runtime/version_text.hpp"

namespace {

using namespace constrictor;

/// The exit status of a command whose output must have arrived.
int written(int status) {
  try {
    cli::write_standard_output();
    return status;
  } catch (const std::runtime_error& error) {
    say_error(fmt::format("constrictor: {}", error.what()));
    return status == exit_status::kOk ? exit_status::kSoftware : status;
  }
}

/// An empty argument is nearly always a variable of the shell that is not set: `--secure "$KEYS"` must not start a run
/// without security.
void refuse_empty_arguments(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const bool no_value = argument.starts_with("--") && argument.find('=') == argument.size() - 1;
    if (!argument.empty() && !no_value) continue;
    const std::string_view named = argument.empty() ? argv[i - 1] : argument.substr(0, argument.size() - 1);
    throw cli::UsageError(
        fmt::format("{}: found nothing, accepted a value (is a variable of the shell not set?)", named));
  }
}

int dispatch(int argc, char** argv) {
  CLI::App app{"Constrictor: a distributed component system for modular snake robots."};
  app.set_version_flag(
      "--version", [] { return version_text("constrictor", kGitRevision); },
      "print the release, the git revision, the hash of the IDL files and Cyclone DDS's version");
  app.require_subcommand(1);
  cli::Action action;
  for (const auto add : cli::kSubcommands) add(app, action);
  cli::add_man_pages(app, action, kGitDate);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    if (argc == 1) {
      fmt::print("{}", app.help());
      return exit_status::kUsage;
    }
    throw cli::UsageError(explain_parse_error(app, error));
  }
  refuse_empty_arguments(argc, argv);
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ::setenv(kLauncherVariable, fmt::format("constrictor {} git {}", kVersion, kGitRevision).c_str(), 1);
    // The options after `host NAME...` belong to constrictor_host.
    const std::string first = argc > 1 ? argv[1] : "";
    const std::string second = argc == 3 ? argv[2] : "";
    if (first == "host" || first == "dashboard" || first == "conform" || first == "camera")
      refuse_empty_arguments(argc, argv);
    if (first == "host" && second != "--help" && second != "-h") return cli::host_command(argc - 2, argv + 2);
    if (first == "dashboard") return cli::dashboard_command(argc - 2, argv + 2);
    if (first == "conform") return cli::conform_command(argc - 2, argv + 2);
    if (first == "camera") return cli::camera_command(argc - 2, argv + 2);
    return written(dispatch(argc, argv));
  } catch (const cli::UsageError& error) {
    say_error(fmt::format("constrictor: {}", error.what()));
    return exit_status::kUsage;
  } catch (...) {
    return report_exception("constrictor");
  }
}
