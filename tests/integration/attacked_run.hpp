// A fixture for runs that are attacked: what the attack costs in memory and in log files.
#pragma once

#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {

class AttackedRun : public RunCommand {
 protected:
  /// [KiB] resident memory of all members together.
  [[nodiscard]] long memory_kib() const {
    long sum = 0;
    for (const auto& [name, pid] : members()) {
      std::ifstream status("/proc/" + std::to_string(pid) + "/status");
      for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) sum += std::stol(line.substr(6));
    }
    return sum;
  }
  /// [byte] all logs of the run that reports into the folder `report`, together.
  [[nodiscard]] std::uintmax_t log_size(const std::string& report) const {
    std::uintmax_t sum = 0;
    for (const auto& entry : fs::directory_iterator(dir_ / report / "logs")) sum += entry.file_size();
    return sum;
  }
};

}  // namespace constrictor::testing
