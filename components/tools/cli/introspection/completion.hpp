// `constrictor completion`: makes scripts with which shells complete subcommands, options and values. The scripts are
// generated from the definitions of the options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace constrictor::cli {

/// A script for "bash", "zsh" or "fish" that completes the subcommands and options of `app`.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace constrictor::cli
