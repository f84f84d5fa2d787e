// Programs that run beside a run without taking part in it: emulated devices.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/child_process.hpp"
#include "cli/fault_director.hpp"
#include "cli/manifest.hpp"

namespace constrictor::cli {

/// Starts the programs that the manifest names under `beside`, before the processes of the run, and ends them after
/// these. Each one is given the run's robot, scenario, seed and folder.
class Companions {
 public:
  using Print = std::function<void(const std::string& line)>;
  /// Throws std::system_error if a program cannot be started.
  Companions(const LaunchManifest& manifest, std::uint64_t seed, const std::filesystem::path& report_dir, Print print);
  /// Sends SIGTERM to all, and SIGKILL to those that have not ended 3 s later.
  ~Companions();
  Companions(const Companions&) = delete;
  Companions& operator=(const Companions&) = delete;

  /// Prints a line for each program that has ended since the last call.
  void poll();
  /// Injects faults into emulated devices, by lines in their command pipes. Prints the devices that do not read theirs.
  void obey(const std::vector<FaultDirector::Command>& commands);

 private:
  struct Companion {
    std::string program;
    std::filesystem::path log;
    std::unique_ptr<ChildProcess> process;
    bool reported = false;
  };
  std::filesystem::path report_dir_;
  std::vector<Companion> companions_;
  Print print_;
};

}  // namespace constrictor::cli
