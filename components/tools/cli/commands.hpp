// The smaller subcommands of `constrictor`: end, diff, host, camera, conform and dashboard. Each function returns an
// exit status.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace constrictor::cli {

/// Replaces this process by another program of this build. Returns only if that fails; throws CommandError if there is
/// no such program.
int become(const char* name, std::vector<std::string> arguments);

/// Asks a run's launcher to end the run and waits until the launcher has ended. Throws CommandError if there is no such
/// run.
int end_command(std::optional<std::uint32_t> domain);

/// Prints the first difference of two runs. Returns 0 if they are equal, 1 if they differ.
int diff_command(const std::filesystem::path& a, const std::filesystem::path& b);

/// `constrictor host NAME... [OPTION...]`: replaces this process by constrictor_host, which hosts these components.
int host_command(int argc, char** argv);

/// `constrictor dashboard [OPTION...]`: replaces this process by the program `dashboard`.
int dashboard_command(int argc, char** argv);
int camera_command(int argc, char** argv);   ///< becomes camera_setup
int conform_command(int argc, char** argv);  ///< becomes conform

}  // namespace constrictor::cli
