// Checks whether a perception keeps the contract of idl/CLIENTS.md, by images whose content is known exactly.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "conform/perception_hand.hpp"
#include "conform/perception_profile.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

/// All checks, in the order in which they are made.
[[nodiscard]] std::vector<Check> perception_checks();

class PerceptionConformance {
 public:
  /// All arguments must outlive this object.
  PerceptionConformance(PartPort& port, const RobotModel& robot, const PerceptionProfile& profile, Report& report)
      : port_(port), profile_(profile), report_(report), hand_(port, robot, profile.answer_s) {}

  /// Makes all checks that can be made. Throws PartGone; the report then has the results so far.
  void run();

 private:
  // Answers, stamps, and images that show nothing (perception_image_checks.cpp).
  bool check_arrival();
  void check_nothing();
  void check_refusals();
  void check_epoch();
  // The line (perception_line_checks.cpp).
  void check_line();
  void check_line_shape();
  void check_line_end();
  void check_line_colour();
  // Objects and zones (perception_object_checks.cpp).
  void check_objects();
  void check_bearing();
  void check_size();
  void check_image_border();

  /// Shows a scene three times and returns the last answer; null if there is none.
  const msg::LinePercept* line_of(const SyntheticScene& scene);
  const msg::ObjectPercepts* objects_of(const SyntheticScene& scene);
  /// The first blob of a colour and kind; null if there is none.
  static const msg::Blob* blob(const msg::ObjectPercepts* percepts, std::uint8_t colour, std::uint8_t kind);

  PartPort& port_;
  const PerceptionProfile& profile_;
  Report& report_;
  PerceptionHand hand_;
  std::vector<Seen> shown_;  ///< the last scene
};

}  // namespace constrictor::conform
