// `constrictor completion`: scripts by which shells complete the command's words, made from the tree of its options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace constrictor::cli {

/// A script for "bash", "zsh" or "fish" that completes the subcommands and options of `app`.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace constrictor::cli
