// For `constrictor conform PART --manifest`, the launcher starts a program of this folder in a run. This header finds
// the files of the program's checks, and writes their results into files that the command reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "conform/report.hpp"

namespace constrictor::conform {

/// How the launcher has started the program.
struct LaunchedChecks {
  std::filesystem::path folder;  ///< holds profile.yaml; lines.txt and result.json are written there
  std::filesystem::path robot;   ///< robot file
  std::string mission;           ///< of the scenario, as YAML on one line; empty: it states none
  std::uint32_t domain = 0;
  /// False: the launcher only asks what the program reads and writes, or whether its files are right.
  bool takes_part = false;
  /// Arguments of host_main: those of the program without the names of the components, which the launcher passes first.
  int argc = 0;
  char** argv = nullptr;
};

/// Reads the arguments and the environment variable CONSTRICTOR_CONFORM, which names the folder. Throws
/// std::invalid_argument if the variable is not set: the launcher has not started the program.
[[nodiscard]] LaunchedChecks launched_checks(int argc, char** argv);

/// Starts the thread of the checks, which calls `run` and then `finish`. Each result is a line of lines.txt as soon as
/// it is known; an exception of `run` is the last line. result.json is written at the end.
[[nodiscard]] std::thread start_checks(const std::filesystem::path& folder, std::vector<Check> checks,
                                       std::function<void(Report&)> run, std::function<void()> finish);

}  // namespace constrictor::conform
