// A fixture for runs on several hosts (namespaces with an sshd each) over a network that loses, delays and reorders
// frames.
#pragma once

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "support/namespace_hosts.hpp"
#include "support/project.hpp"

namespace constrictor::testing {

using namespace std::chrono_literals;

inline const std::vector<std::string> kPrograms = {
    "constrictor", "constrictor_host", "toy_host",   "physics", "camera",  "perception",
    "guidance",    "control",          "navigation", "input",   "planner", "report"};

/// Cyclone DDS's own times, in place of those of the built-in configuration.
inline constexpr const char* kDefaultTimes =
    "CYCLONEDDS_URI='<CycloneDDS><Domain><Internal><NackDelay>100ms</NackDelay><AutoReschedNackDelay>1s"
    "</AutoReschedNackDelay><HeartbeatInterval min=\"5ms\" minsched=\"20ms\" max=\"8s\">100ms</HeartbeatInterval>"
    "</Internal></Domain></CycloneDDS>' ";

class LongHosts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = NamespaceHosts::missing(); !missing.empty()) GTEST_SKIP() << missing;
  }
  void make(int count) { hosts_ = std::make_unique<NamespaceHosts>(count, kPrograms, testing::source_path()); }

  /// Writes the manifest of the toys: three of the five processes run on host2.
  void write_toys(int patience_s = 60) const {
    std::ofstream(hosts_->tmp(1) / "toys.yaml")
        << "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\n"
        << "patience_s: " << patience_s << "\nhosts: {here: local, robot: {ssh: root@10.77.0.2}}\nprocesses:\n"
        << "  - {components: [physics], program: toy_host}\n"
           "  - {components: [navigation], program: toy_host, host: robot}\n"
           "  - {components: [control], program: toy_host, host: robot}\n"
           "  - {components: [planner], program: toy_host}\n"
           "  - {components: [report], program: toy_host, host: robot}\n";
  }
  /// A run of toys, reported in the folder `name` of host1.
  [[nodiscard]] Process toys(long ticks, const std::string& name, const std::string& options = "",
                             const std::string& environment = "") const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    std::ofstream(hosts_->tmp(1) / scenario) << "";
    return hosts_->on(
        1, environment + "exec constrictor run " + scenario + " --manifest toys.yaml --report " + name + " " + options);
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(hosts_->tmp(1) / name / "report.json"), nullptr, false);
  }
  /// The state hash of a run of toys in one process.
  std::string reference(long ticks) {
    Process run = toys(ticks, "one", "--in-process");
    EXPECT_EQ(run.wait(60s), 0) << run.output() << run.errors();
    return report("one").value("state_hash", "none");
  }
  /// Runs toys to the end, compares the result with `expected`, and returns the ticks per second.
  double rate(long ticks, const std::string& expected, const std::string& what, const std::string& environment = "") {
    Process run = toys(ticks, "run", "", environment);
    EXPECT_EQ(run.wait(300s), 0) << what << ": " << run.output() << run.errors();
    const auto json = report("run");
    EXPECT_EQ(json.value("state_hash", ""), expected) << what;
    const double per_s = static_cast<double>(ticks) / json.value("wall_time_s", 1e9);
    std::printf("%-40s %7.1f ticks/s\n", what.c_str(), per_s);
    std::fflush(stdout);
    return per_s;
  }
  /// The newest tick of the run as `constrictor status` shows it, which joins the run without set-up; -1: none.
  [[nodiscard]] std::int64_t newest_tick() const {
    Process status = hosts_->on(1, "exec constrictor status --json");
    if (status.wait(20s) != 0) return -1;
    std::int64_t newest = -1;
    const auto json = nlohmann::json::parse(status.output(), nullptr, false);
    if (!json.is_object()) return -1;
    for (const auto& component : json.value("components", nlohmann::json::array()))
      newest = std::max(newest, component.value("tick", std::int64_t{-1}));
    return newest;
  }
  /// `kept`: the run may be continued, so that what its processes have written is kept.
  void expect_nothing_left(int host, bool kept = false) const {
    EXPECT_TRUE(eventually([&] { return hosts_->processes(host, "toy_host").empty(); }, 30s)) << "on host " << host;
    EXPECT_TRUE(eventually([&] { return hosts_->processes(host, "--token").empty(); }, 30s)) << "on host " << host;
    for (const auto& entry : std::filesystem::directory_iterator(hosts_->tmp(host) / "constrictor-0"))
      EXPECT_EQ(entry.path().extension(), ".lock") << entry.path();
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(hosts_->tmp(host) / "state/constrictor", none))
      EXPECT_TRUE(kept) << entry.path() << " is kept";
  }

  std::unique_ptr<NamespaceHosts> hosts_;
};

}  // namespace constrictor::testing
