// The other hosts of a run, as the launcher sees them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/launch_plan.hpp"
#include "cli/remote/host_link.hpp"
#include "cli/supervisor.hpp"
#include "cyclone/domain_claim.hpp"

namespace constrictor::cli {

/// The description of a run for its hosts.
struct HostOptions {
  std::string token;             ///< names the run on all hosts; a run that is continued has the token of its begin
  std::filesystem::path secure;  ///< folder with the keys of the run; empty: without DDS Security
  bool keep = true;              ///< the run can be continued, so that hosts keep what it has written until it is over
  bool resume = false;           ///< this launcher continues the run
};

/// Adds identities and their files to `message`, which is the message `prepare` for `host`: those of the processes on
/// this host that have no keys of their own. The files are read from `folder`; with an empty path nothing is added.
/// Throws HostError if a file cannot be read.
void add_keys(const std::filesystem::path& folder, const LaunchManifest& manifest, const std::string& host,
              nlohmann::json& message);

/// A new token.
[[nodiscard]] std::string new_hosts_token();

class HostSet {
 public:
  /// Connects to all hosts of the manifest and compares them with this one; does nothing if it names none. `wait` is
  /// called meanwhile; it waits a moment, and throws to interrupt. Throws HostError with all differences.
  HostSet(const LaunchManifest& manifest, HostOptions options, HostLink::Print print, std::function<void()> wait);
  ~HostSet();
  HostSet(const HostSet&) = delete;
  HostSet& operator=(const HostSet&) = delete;

  /// The DDS domains that are in use on one of the other hosts.
  [[nodiscard]] std::set<std::uint32_t> used_domains() const;
  /// Claims the domain on all hosts, publishes the DDS configuration, and sends the files of the run, `token_file`
  /// among them, and the keys of each host's own processes. Throws HostError.
  void prepare(std::uint32_t domain, const std::filesystem::path& report_dir, const std::filesystem::path& token_file);
  /// For the supervisor: starts a process on the host that its plan names.
  [[nodiscard]] std::unique_ptr<Child> start(const ProcessPlan& plan, std::uint32_t incarnation,
                                             const std::vector<std::string>& argv,
                                             const std::vector<std::string>& environment,
                                             const std::filesystem::path& log);
  /// The checkpoint from which the plant on another host continues the run, as a text; empty: the plant is here, or the
  /// run is new.
  [[nodiscard]] std::string continued() const;
  /// Fetches the files that the processes of the other hosts have written into the report's directory, and ends the
  /// agents. All processes must have ended. `over`: the run will not be continued.
  void finish(bool over);
  /// For report.json: {name: {host, release, libraries ...}}, this host first, under the name "here". Null without
  /// other hosts.
  [[nodiscard]] nlohmann::ordered_json report() const;

 private:
  void connect();
  void compare() const;
  /// Ends the agents that can be reached, with all their processes.
  void end_agents();
  void add_file(const std::filesystem::path& file);
  void exchange();
  /// Calls exchange() until `done` returns true. False after `bound`.
  bool exchange_until(const std::function<bool()>& done, std::chrono::milliseconds bound);
  /// Waits until all files that the other hosts send have arrived, as long as bytes arrive. A signal of the user ends
  /// it.
  void collect_files(const std::function<bool()>& done);
  /// The argument with the paths of the run's files replaced by those on the host.
  [[nodiscard]] std::string there(const HostLink& link, const std::string& argument) const;

  const LaunchManifest& manifest_;
  HostOptions options_;
  bool keep_at_end_ = options_.resume;  ///< a new run that does not begin leaves nothing
  HostLink::Print print_;
  std::function<void()> wait_;
  std::vector<std::unique_ptr<HostLink>> links_;
  nlohmann::json ours_;
  std::map<std::string, std::string> default_configs_;  ///< path by component
  std::map<std::string, std::string> places_;           ///< of each file in an agent's folder, by path on this host
  nlohmann::json files_ = nlohmann::json::array();
  std::filesystem::path report_dir_;
  std::string dds_xml_;
  PublishedDdsConfiguration dds_;
};

}  // namespace constrictor::cli
