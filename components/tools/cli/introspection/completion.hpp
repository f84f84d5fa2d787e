// `constrictor completion`: scripts by which shells complete the command's words, made from the tree of its options.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace constrictor::cli {

/// A script for "bash", "zsh" or "fish" that completes the subcommands and options of `app`.
std::string completion_script(const CLI::App& app, const std::string& shell);

/// `action` is set to what the parsed command shall do; it returns the exit status.
void add_completion(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
