// A launch manifest of deploy/: the processes of a run, and the components that each of them hosts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scheduling/scheduling.hpp"

namespace constrictor {
class Configuration;
}

namespace constrictor::cli {

/// A host of a run, as the manifest describes it.
struct HostPlan {
  std::string ssh;        ///< destination for ssh, "user@10.0.0.2"; empty: the launcher's own host
  std::string interface;  ///< network interface for DDS, "eth0"; empty: the one that holds the address
  std::string address;    ///< IPv4 address for DDS; empty: the one by which ssh or the other hosts reach this host
  std::filesystem::path directory;  ///< of the installation; relative to the home directory; empty: the usual ones
};

/// One process of a run.
struct ProcessPlan {
  std::vector<std::string> components;  ///< components that the process hosts, at least one
  std::string program;  ///< empty: the component's own program, or constrictor_host for several components
  int restarts = 100;   ///< largest number of restarts
  std::vector<std::string> environment;  ///< "NAME=VALUE", added to the launcher's environment
  std::string host = {};                 ///< name of the host that it runs on; empty: the launcher's
  Scheduling scheduling = {};            ///< at real-time pace

  /// "control", or "navigation+control" if it hosts several.
  [[nodiscard]] std::string name() const;
};

/// Whether the manifest names a folder of keys on the process's own host, which the launcher leaves as they are.
[[nodiscard]] bool has_own_keys(const ProcessPlan& process);

/// A program that runs beside the run without taking part in it, such as emulated devices.
struct CompanionPlan {
  std::string program;
  std::vector<std::string> arguments;  ///< besides --robot, --scenario, --seed and --output
};

/// The program and its arguments for an incarnation of a process.
using CommandLine = std::function<std::vector<std::string>(const ProcessPlan& process, std::uint32_t incarnation)>;

struct LaunchManifest {
  std::string plant;  ///< name of the component that is the plant
  std::filesystem::path robot_file;
  std::filesystem::path scenario_file;
  bool real_time = false;  ///< the plant drives real joints: the pace of the run is `realtime`
  std::vector<CompanionPlan> beside;
  double patience_s = 60.0;  ///< [s] wall time that a process waits for another one before it gives up
  std::vector<ProcessPlan> processes;
  std::map<std::string, std::uint16_t> latency_ticks;         ///< least latency by component; absent: its own
  std::vector<std::string> order;                             ///< of the roster; empty: that of the processes
  std::filesystem::path faults_file;                          ///< absolute; set by `run --faults`; empty: no faults
  std::map<std::string, std::filesystem::path> config_files;  ///< by component; absent: the default file
  HostPlan here;                                              ///< the launcher's own host
  std::map<std::string, HostPlan> hosts;                      ///< the other hosts, by name
  int packet_bytes = 1400;                                    ///< [byte] largest packet of a run with other hosts

  /// ProcessPlan::host of the plant's process.
  [[nodiscard]] std::string host_of_plant() const;
  /// Every component, in the order that is part of the run's identity.
  [[nodiscard]] std::vector<std::string> roster() const;
};

/// Reads a manifest; paths in it are relative to the project's root. Throws ConfigurationError, also if a component is
/// named twice, the plant is not among the components, or `roster` does not name each of them once.
LaunchManifest load_manifest(const std::filesystem::path& file);

/// Reads `hosts`, and checks the hosts that the processes of `manifest` name. Hosts without a process are left out.
/// A process on the launcher's own host then has an empty host. Throws ConfigurationError.
void read_hosts(Configuration& root, LaunchManifest& manifest);

/// Puts each group of components into one process of its own; other components stay where they are. Call roster()
/// before: the order of the roster must not depend on the grouping. Throws ConfigurationError if a component is
/// unknown or in two groups.
void regroup(LaunchManifest& manifest, const std::vector<std::vector<std::string>>& groups);

/// The options "--config NAME=FILE" for those of `components` that do not use their default configuration.
std::vector<std::string> config_arguments(const LaunchManifest& manifest, const std::vector<std::string>& components);

/// The options "--latency NAME=TICKS". They are the same for all processes of a run.
std::vector<std::string> latency_arguments(const LaunchManifest& manifest);

}  // namespace constrictor::cli
