// The processes of this host and their command lines.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace constrictor::testing {

/// The command line of each process: its arguments, each with a final '\0'. It is empty for a process that ends
/// meanwhile.
inline std::map<pid_t, std::string> command_lines() {
  std::map<pid_t, std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string pid = entry.path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::ifstream file(entry.path() / "cmdline");
    std::ostringstream text;
    text << file.rdbuf();  // unlike an iterator, this does not throw when the process has just ended
    found[std::stoi(pid)] = text.str();
  }
  return found;
}

/// The processes whose command line names this folder, by the names of their programs.
inline std::map<std::string, pid_t> processes_naming(const std::filesystem::path& folder) {
  std::map<std::string, pid_t> found;
  for (const auto& [pid, line] : command_lines()) {
    if (line.find(folder.string()) == std::string::npos) continue;
    found[std::filesystem::path(line.substr(0, line.find('\0'))).filename().string()] = pid;
  }
  return found;
}

}  // namespace constrictor::testing
