// The main function of programs that measure a robot in the simulated world and draw what they have found.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "support/project.hpp"

namespace constrictor::bench {

/// Reads the options --robot and --output, and calls `measure` with a robot file and a folder. `name`: of the program,
/// and of its folder in build/. `what`: for --help. `files`: the names of the files that it writes, for --help.
inline int measure_main(int argc, char** argv, const std::string& name, const std::string& what,
                        const std::string& files,
                        void (*measure)(const std::filesystem::path& robot_file, const std::filesystem::path& output)) {
  CLI::App app(what);
  std::string robot = testing::robot_path("mamba");
  std::string output = "build/" + name;
  app.add_option("--robot", robot, "robot file (YAML)")->check(CLI::ExistingFile);
  app.add_option("--output", output, "folder for " + files);
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(output);
    measure(robot, output);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 1;
  }
}

}  // namespace constrictor::bench
