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
  double zone_range_m = 1.0;              ///< a drop zone nearer than this is dropped on
  double turned_rad = 0.7;                ///< the course is right again within this angle of the outbound one
  double explore_s = 12.0;                ///< [s] exploring before turning
  double rotate_s = 10.0;                 ///< [s] turning before exploring again
  double turn_round_s = 40.0;             ///< [s] turning back after a drop
  double task_timeout_s = 240.0;          ///< [s] pregrasp, grasp, drop, track
  double follow_timeout_s = 300.0;        ///< [s] following a line
  double mission_timeout_s = 3600.0;      ///< [s]
  int max_recoveries = 60;
};

/// Reads and checks a planner file. Throws ConfigurationError.
PlannerConfig load_planner_config(const std::filesystem::path& file);

}  // namespace constrictor
