// Functions that all subcommands of `constrictor conform` use.
#pragma once

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "configuration/parameter_set.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

struct Options {
  std::optional<std::uint32_t> domain;  ///< in which the part is already; not with a manifest
  std::uint16_t robot_id = 1;
  std::string robot = "mamba", scenario = "case_study", profile, json, manifest;
  double patience_s = 60.0;     ///< in which a part that is started by hand must join
  std::string restart_command;  ///< ends the plant's process and starts it again; empty: not given
  bool yes = false, list = false, show_profile = false;
};

/// The number of the signal that has asked this process to end; 0: none has.
[[nodiscard]] int signal_number();
/// From this call on, SIGINT, SIGTERM and SIGHUP are noted instead of ending the process.
void note_signals();

/// The robot file, scenario file or manifest with this path or name. They throw ConfigurationError if there is none.
[[nodiscard]] std::filesystem::path robot_file(const std::string& name);
[[nodiscard]] std::filesystem::path scenario_file(const std::string& name);
[[nodiscard]] std::filesystem::path manifest_file(const std::string& name);
void print_line(const std::string& line);

/// --list and --show-profile. True if one of them was asked for.
[[nodiscard]] bool shown(const Options& options, const std::vector<Check>& checks,
                         const std::vector<ParameterRow>& profile);
/// Whether the user agrees to what `warning` says; asks only on a terminal.
[[nodiscard]] bool agreed(const std::string& warning);
/// Prints the summary, writes the file of --json, and returns the exit status. `gone`: why the checks have ended early.
[[nodiscard]] int concluded(const Options& options, const Report& report, const std::string& gone);

/// Checks the part in a run that `run(folder)` makes, and returns the exit status. `run` returns false if there is no
/// result.
[[nodiscard]] int check_in_run(const Options& options, const std::function<bool(const std::filesystem::path&)>& run);

// The subcommands. Each returns the exit status; they throw ConfigurationError.
[[nodiscard]] int plant_command(const Options& options);
[[nodiscard]] int part_command(const Options& options, const std::string& part);

}  // namespace constrictor::conform
