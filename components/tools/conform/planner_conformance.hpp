// Checks whether a planner keeps the contract of idl/CLIENTS.md: plays a whole mission to it, in which requests are
// refused and lost, authority is taken away, and objects are lost.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "component/mission.hpp"
#include "conform/planner_hand.hpp"
#include "conform/planner_profile.hpp"
#include "conform/report.hpp"
#include "constrictor/constants.hpp"

namespace constrictor::conform {

/// All checks, in the order in which they are made.
[[nodiscard]] std::vector<Check> planner_checks();

[[nodiscard]] inline const char* colour_name(std::uint8_t colour) { return name_of(constants::kColour, colour); }
[[nodiscard]] inline const char* task_name(std::uint8_t task) { return name_of(constants::kTask, task); }

/// The mission that the planner was given: that of a scenario, as YAML on one line; if the text is empty, first green,
/// then red, along a blue line. Throws ConfigurationError.
[[nodiscard]] Mission mission_of(const std::string& yaml);

class PlannerConformance {
 public:
  /// All arguments must outlive this object.
  PlannerConformance(PartPort& port, Mission mission, const PlannerProfile& profile, Report& report)
      : port_(port), mission_(std::move(mission)), profile_(profile), report_(report) {
    hand_.emplace(port);
  }

  /// Makes all checks that can be made. Throws PartGone; the report then has the results so far.
  void run();

 private:
  using Tasks = std::initializer_list<std::uint8_t>;
  // Disturbances before an object is found (planner_start_checks.cpp). False: the planner does not continue.
  bool check_arrival();
  bool check_line();
  void check_authority();
  void check_lost_requests();
  // The mission (planner_mission_checks.cpp).
  bool check_object();
  bool check_delivery(std::size_t index);
  void check_end();
  void check_form();
  void check_epoch();

  /// Goes on until the planner starts one of these tasks; false if it does not within `seconds`.
  bool starts(Tasks tasks, double seconds);
  /// starts(), and judges it.
  bool follows(const char* check, Tasks tasks, double seconds, const char* todo);
  /// Number of starts while `seconds` pass.
  std::size_t requests_in(double seconds);
  /// "follow_line, colour blue", or that there was no request.
  [[nodiscard]] std::string newest() const;
  bool brings_object_to(std::size_t index);

  PartPort& port_;
  Mission mission_;
  const PlannerProfile& profile_;
  Report& report_;
  std::optional<PlannerHand> hand_;  ///< anew in each epoch
};

}  // namespace constrictor::conform
