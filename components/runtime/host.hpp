// Hosts any set of components in this process: queues between them, DDS to everybody else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/component.hpp"

namespace constrictor {

/// Exit statuses of every Constrictor process (sysexits.h).
namespace exit_status {
inline constexpr int kOk = 0;
inline constexpr int kMissionFailed = 1;
inline constexpr int kUsage = 64;
inline constexpr int kSoftware = 70;
inline constexpr int kWaitedTooLong = 75;  ///< a peer did not deliver within the patience
inline constexpr int kRefused = 76;        ///< the conductor refused this process
inline constexpr int kConfiguration = 78;
}  // namespace exit_status

struct HostOptions {
  std::uint32_t domain = 0;
  std::vector<std::string> roster;       ///< every member of the run, here or elsewhere
  std::string plant = "physics";         ///< who among them is the time master
  std::uint32_t incarnation = 1;         ///< of this process
  std::uint64_t run_id = 0;              ///< as the launcher numbers the run; 0: any run that begins in the domain, or a random number
  double pace = 0.0;                     ///< plant's host: at most so many times real time; 0: lock-step, uncapped
  double operator_pace = 1.0;            ///< plant's host: the same while an operator has authority; 0: no such cap
  bool realtime = false;                 ///< plant's host: ticks on the wall clock, nobody is waited for
  double max_sim_time_s = 0.0;           ///< plant's host: ends the run at this simulated time; 0: never
  double patience_s = 60.0;              ///< wait so long for a peer before giving up; 0: for ever
  bool hash_log = true;                  ///< plant's host: write output_dir/hashes.bin, what `constrictor diff` compares
  bool record = false;                   ///< plant's host: also the messages themselves, images aside
  Setup setup;                           ///< component name aside
  std::map<std::string, std::filesystem::path> config_files;  ///< by component; absent: its default
};

class Host {
 public:
  /// Builds the components. Throws ConfigurationError or dds::Error.
  Host(HostOptions options, std::vector<ComponentFactory> factories);
  ~Host();
  /// From here on SIGTERM and SIGINT are wishes to end, which run() obeys, also those that came before it. To be called first of all:
  /// building components and finding the others takes a while.
  static void heed_signals();
  /// Takes part until the run ends, a signal (SIGTERM, SIGINT) or an error. Returns the exit status.
  int run();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace constrictor
