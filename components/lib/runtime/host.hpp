// Hosts any set of components in one process: they exchange messages by direct calls, and with other processes by DDS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "runtime/recording_options.hpp"

namespace constrictor {

/// Exit statuses of every Constrictor process (sysexits.h).
namespace exit_status {
inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;  ///< the mission, task or request did not succeed
inline constexpr int kUsage = 64;
inline constexpr int kSoftware = 70;
inline constexpr int kWaitedTooLong = 75;  ///< a peer did not deliver within the patience
inline constexpr int kRefused = 76;        ///< the conductor refused this process
inline constexpr int kConfiguration = 78;
}  // namespace exit_status

/// Environment variable in which a launcher names itself and its git revision for the first log line of the processes
/// that it starts.
inline constexpr const char* kLauncherVariable = "CONSTRICTOR_LAUNCHER";

struct HostOptions {
  std::uint32_t domain = 0;
  std::vector<std::string> roster;  ///< every member of the run, in this or another process
  std::string plant = "physics";    ///< the member that is the plant
  std::uint32_t incarnation = 1;    ///< incarnation of this process
  bool replace = false;             ///< the components take the place of ones with another configuration
  std::uint64_t run_id = 0;         ///< the launcher's number of the run; 0: the first run in the domain; plant: random
  std::string token;            ///< of the run, which clients and members must know; empty: nothing is asked of them
  double pace = 0.0;            ///< plant only: at most this many times real time; 0: no limit
  double operator_pace = 1.0;   ///< plant only: the same while an operator has authority; 0: no limit
  bool realtime = false;        ///< plant only: ticks follow the wall clock and wait for no member
  double max_sim_time_s = 0.0;  ///< plant only: ends the run at this simulated time; 0: never
  double patience_s = 60.0;    ///< [s] wall time that the process waits for another one before it gives up; 0: for ever
  bool hash_log = true;        ///< plant only: writes output_dir/hashes.bin, which `constrictor diff` compares
  RecordingOptions recording;  ///< plant only: of run.mcap in output_dir
  bool checkpoints = true;     ///< plant only: stores checkpoints in output_dir, so that its process can be restarted
  Setup setup;                 ///< of every component; its name is set by the host
  std::map<std::string, std::uint16_t> latency_ticks;  ///< by member of the roster; absent: that of the component
  std::filesystem::path faults_file;                   ///< faults to inject into the run; empty: none
  std::map<std::string, std::filesystem::path> config_files;  ///< by component; a component without one has its default
};

class Host {
 public:
  /// Builds the components. Throws what their constructors throw (ConfigurationError), or dds::Error.
  Host(HostOptions options, std::vector<ComponentFactory> factories);
  ~Host();
  /// From this call on, SIGTERM and SIGINT no longer end the process at once: run() returns instead. To be called at
  /// the start of main(), because building the components takes a while.
  static void heed_signals();
  /// Takes part until the run ends, a signal comes (SIGTERM, SIGINT) or an error occurs. Returns the exit status.
  int run();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace constrictor
