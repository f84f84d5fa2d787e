#include "navigation/object_limits.hpp"

#include <fmt/format.h>

namespace constrictor {
namespace {

// Missions with boxes that stand at any angle (navigation/README.md): a square succeeded whenever half of its diagonal
// looked no larger than the largest object, in five of eight missions with 1.19 times the radius of the U, and in one
// of eight with 1.25 times.
constexpr double kLargestBox = 1.2;  // half of the diagonal, by the radius of the U

/// A box turns to the U as it likes, and the robot sees it from all sides.
void judge_box(const GripSense& sense, const RobotModel& robot, const DemandedObject& object, CheckVerdict& verdict) {
  const double half_m = object.radius_m();
  const double largest_m = kLargestBox * sense.largest_radius_m();
  if (half_m > largest_m) {
    verdict.refusals.push_back(
        fmt::format("{}: found a diagonal of {:.3f} m, accepted at most {:.3f} m for the footprint: the U of {} holds "
                    "no larger box",
                    object.size_key(), 2.0 * half_m, 2.0 * largest_m, robot.name));
  } else if (0.5 * object.length_m > sense.largest_seen_radius_m()) {
    verdict.refusals.push_back(fmt::format(
        "{}: found a side of {:.3f} m, accepted at most {:.3f} m: the robot {} sees it as larger than its U",
        object.size_key(), object.length_m, 2.0 * sense.largest_seen_radius_m(), robot.name));
  } else if (half_m > sense.largest_seen_radius_m()) {
    verdict.warnings.push_back(fmt::format(
        "{}: found a diagonal of {:.3f} m, reliable up to {:.3f} m for the footprint: from the direction of its "
        "diagonal the robot {} sees it as larger than its U, and does not grasp it from there",
        object.size_key(), 2.0 * half_m, 2.0 * sense.largest_seen_radius_m(), robot.name));
  }
}

// Half of the width of an object, by the radius of a module. Missions of `short` with a radius of 0.03 m succeeded,
// with 0.02 m (0.57) four of seven, and with 0.015 m (0.43) and less none of nine: the object slips through the U, or
// passes below the camera unseen.
constexpr double kNarrowest = 0.5;
constexpr double kNarrow = 0.85;

void judge_width(const RobotModel& robot, const DemandedObject& object, CheckVerdict& verdict) {
  const double half_m = 0.5 * object.width_m;
  const double least_m = kNarrowest * robot.module_radius_m, reliable_m = kNarrow * robot.module_radius_m;
  if (half_m >= reliable_m) return;
  const bool refused = half_m < least_m;
  (refused ? verdict.refusals : verdict.warnings)
      .push_back(fmt::format("{}: found a width of {:.3f} m, {} {:.3f} m: the U of {} loses a narrower object",
                             object.size_key(), object.width_m, refused ? "accepted at least" : "reliable from",
                             2.0 * (refused ? least_m : reliable_m), robot.name));
}

// The body lies on the ground, and touches at the height of its axis what is not lower.
void judge_height(const RobotModel& robot, const DemandedObject& object, CheckVerdict& verdict) {
  if (object.height_m >= robot.module_radius_m) return;
  verdict.refusals.push_back(fmt::format(
      "{}: found a height of {:.3f} m, accepted at least {:.3f} m (module.radius_m): the body of {} slides over it",
      object.height_key(), object.height_m, robot.module_radius_m, robot.name));
}

// Missions of `short` (navigation/README.md): objects of up to 3 times their width succeeded always, of 4 times in half
// of the missions, and of 5 times in none.
constexpr double kSlender = 4.5;
constexpr double kSteady = 3.1;

void judge_slenderness(const DemandedObject& object, CheckVerdict& verdict) {
  const double steady_m = kSteady * object.width_m;
  const auto found = [&](const char* accepted, double most_m, const char* why) {
    return fmt::format("{}: found a height of {:.3f} m, {} {:.3f} m for a width of {:.3f} m: {}", object.height_key(),
                       object.height_m, accepted, most_m, object.width_m, why);
  };
  if (object.height_m > kSlender * object.width_m) {
    verdict.refusals.push_back(found("accepted at most", kSlender * object.width_m,
                                     "the object falls over when the body meets it, and no U holds one that lies"));
  } else if (object.height_m > steady_m) {
    verdict.warnings.push_back(found("reliable up to", steady_m, "the object may fall over when the body meets it"));
  }
}

}  // namespace

CheckVerdict judge_object(const GripSense& sense, const RobotModel& robot, const DemandedObject& object) {
  CheckVerdict verdict;
  if (!sense.refusal().empty()) return verdict;  // the mission is refused for the robot
  if (object.box) {
    judge_box(sense, robot, object, verdict);
  } else if (object.radius_m() > sense.largest_radius_m()) {
    verdict.refusals.push_back(
        fmt::format("{}: found {:.3f} m, accepted at most {:.3f} m: the U of {} holds no larger "
                    "object",
                    object.size_key(), object.radius_m(), sense.largest_radius_m(), robot.name));
  }
  judge_width(robot, object, verdict);
  judge_height(robot, object, verdict);
  judge_slenderness(object, verdict);
  return verdict;
}

}  // namespace constrictor
