// Parameters of the planner; see planner.yaml.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace constrictor {

struct PlannerConfig {
  std::vector<std::uint8_t> sequence;     ///< colours of the objects, in the order of retrieval
  std::uint8_t line_colour = 0;
  int confirm_images = 3;                 ///< consecutive images in which a thing must be seen
  double object_range_m = 1.6;            ///< an object nearer than this is approached
  double zone_range_m = 1.2;              ///< a drop zone nearer than this is dropped on
  double on_zone_m = 0.6;                 ///< an object nearer than this to the zone on which one of its colour was dropped is left alone
  double remembered_range_m = 2.5;        ///< an object or zone of the map nearer than this is searched for where it was
  double aligned_rad = 1.0;               ///< the head faces the wanted way along the line within this angle
  double straight_rad = 0.6;              ///< of head against body, beyond which the body is too curled to follow a line
  double explore_s = 12.0;                ///< [s] exploring before something else is tried
  double rotate_s = 10.0;                 ///< [s] turning before something else is tried
  double after_end_s = 8.0;               ///< [s] for which the line is not taken again after its end
  double turn_round_s = 20.0;             ///< [s] turning back after a drop
  double search_timeout_s = 180.0;        ///< [s] searching for the line until that counts as a recovery
  double task_timeout_s = 240.0;          ///< [s] search object, track, pregrasp, grasp, drop
  double follow_timeout_s = 120.0;        ///< [s] following a line
  double mission_timeout_s = 3600.0;      ///< [s]
  double holding_factor = 4.0;            ///< how much longer searching, turning and following may take with an object
  int max_recoveries = 60;
};

/// Reads and checks a planner file. Throws ConfigurationError.
PlannerConfig load_planner_config(const std::filesystem::path& file);

}  // namespace constrictor
