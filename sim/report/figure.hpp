// The figure of a run, after the paper's Fig. 4: for each key moment the scene, the raw image, the processed image and
// the joint torques.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace constrictor::report {

struct FigureHeading {
  std::string title;
  std::string subtitle;
  std::string failure;  ///< why the mission did not succeed; empty if it succeeded
};

struct FigureRow {
  double time_s = 0.0;
  std::string caption;                             ///< what happened
  std::string state;                               ///< state of the planner
  std::uint8_t colour = 0;                         ///< msg::kColour… of the object or line
  std::filesystem::path scene, camera, processed;  ///< pictures; a missing file leaves an empty frame
};

/// Torques of the yaw joints over time.
struct TorqueSeries {
  std::vector<double> time_s;
  std::vector<std::vector<double>> torque_nm;  ///< a series for each joint, head to tail, as long as time_s
};

/// Reads joint_torques.csv: a heading, then a line "time,torque,torque,…" for each sample.
[[nodiscard]] TorqueSeries parse_torques(const std::string& csv);

/// Draws the figure: 8-bit BGR, 1400 pixels wide. Each torque plot shows `window_s`.
[[nodiscard]] cv::Mat draw_figure(const FigureHeading& heading, const std::vector<FigureRow>& rows,
                                  const TorqueSeries& torques, double window_s);

}  // namespace constrictor::report
