// The smaller subcommands of `constrictor`. Each returns an exit status.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace constrictor::cli {

/// Asks a run's launcher to end it and waits until it did. Throws RegistryError if the run cannot be told.
int end_command(std::optional<std::uint32_t> domain);

/// Says where two runs part. 0: equal, 1: they differ.
int diff_command(const std::filesystem::path& a, const std::filesystem::path& b);

/// `constrictor host NAME... [OPTION...]`: becomes constrictor_host, which hosts these components in one process.
int host_command(int argc, char** argv);

}  // namespace constrictor::cli
