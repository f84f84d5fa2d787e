// The command line of the example plants.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace example {

struct Options {
  std::uint32_t domain = 0;
  std::size_t joints = 23;
};

/// Reads the command line; ends the program with a hint if it is wrong, and after --help.
inline Options read_options(const char* program, long most_joints, int argc, char** argv) {
  const auto usage = [&](int status) {
    std::fprintf(status ? stderr : stdout,
                 "usage: %s --domain N [--joints COUNT]\n"
                 "  --domain  DDS domain of the run, as `constrictor run` prints it\n"
                 "  --joints  number of joints of the robot, 1 to %ld (default 23)\n",
                 program, most_joints);
    std::exit(status);
  };
  const auto number = [&](const char* text, long least, long most) {
    char* end = nullptr;
    const long value = std::strtol(text, &end, 10);
    if (end == text || *end != '\0' || value < least || value > most) usage(64);
    return value;
  };
  long domain = -1, joints = 23;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--help") usage(0);
    if (++i == argc) usage(64);
    if (name == "--domain") domain = number(argv[i], 0, 229);
    else if (name == "--joints") joints = number(argv[i], 1, most_joints);
    else usage(64);
  }
  if (domain < 0) usage(64);
  return {static_cast<std::uint32_t>(domain), static_cast<std::size_t>(joints)};
}

}  // namespace example
