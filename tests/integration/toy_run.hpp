// Runs of toy components (tests/unit/runtime/toy_components.hpp) in processes of their own.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace constrictor::testing {

using namespace std::chrono_literals;

inline const std::string kRoster = "physics,navigation,control,planner,report";
inline const std::vector<std::string> kEach = {"physics", "navigation", "control", "planner", "report"};

/// A run of the toys in a domain of its own; `groups` are the processes.
struct ToyRun {
  DomainClaim claim;
  long ticks;
  std::vector<std::string> extra;
  std::map<std::string, Process> processes;

  explicit ToyRun(long run_ticks, std::vector<std::string> options = {})
      : ticks(run_ticks), extra(std::move(options)) {}

  void start(const std::string& group, int incarnation = 1, const std::map<std::string, std::string>& environment = {},
             const std::string& roster = kRoster) {
    std::vector<std::string> arguments = {program("toy_host"), group,  "--domain",      std::to_string(claim.domain()),
                                          "--roster",          roster, "--scenario",    std::to_string(ticks),
                                          "--robot",           "",     "--incarnation", std::to_string(incarnation)};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    processes.insert_or_assign(group, Process(arguments, environment));
  }
  void start_all(const std::vector<std::string>& groups) {
    for (const auto& group : groups) start(group);
  }
  /// Waits until an incarnation of a member has done a step.
  [[nodiscard]] bool wait_for_step_of(const std::string& component, std::uint32_t incarnation) const {
    return wait_for_step_of(dds::Domain(claim.domain()), component, incarnation);
  }
  [[nodiscard]] static bool wait_for_step_of(const dds::Domain& domain, const std::string& component,
                                             std::uint32_t incarnation) {
    const auto reader = dds::Reader<msg::ComponentStatus>::member(domain.participant(), barrier_topics::kStatus);
    bool seen = false;
    return eventually([&] {
      reader.take([&](const msg::ComponentStatus& s) {
        seen |= s.component == component && s.incarnation == incarnation && s.tick >= 0;
      });
      return seen;
    });
  }
  /// Waits for the report's result; the empty string if anything failed.
  std::string result(std::chrono::seconds bound = 60s) {
    std::string text;
    for (auto& [group, process] : processes) {
      const auto status = process.wait(bound);
      if (status != exit_status::kOk)
        ADD_FAILURE() << group << " ended with " << status.value_or(-1) << ": " << process.errors();
      text += process.output();
    }
    return text;
  }
};

/// The result of a run in one process, with which others are compared.
inline std::string reference(long ticks) {
  ToyRun run(ticks);
  run.start_all({kRoster});
  return run.result();
}

}  // namespace constrictor::testing
