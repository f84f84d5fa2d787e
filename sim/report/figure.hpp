// The paper's Fig. 4 over time: for each key moment the scene, the raw image, the processed image and the joint torques.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace constrictor::report {

struct FigureRow {
  double time_s = 0.0;
  std::string caption;          ///< what happened
  std::string state;            ///< the planner's state
  std::uint8_t colour = 0;      ///< msg::kColour… of what it is about
  std::filesystem::path scene, camera, processed;  ///< pictures; missing ones leave an empty frame
};

/// Torques of the yaw joints over time.
struct TorqueSeries {
  std::vector<double> time_s;
  std::vector<std::vector<double>> torque_nm;  ///< by joint from the head, each as long as time_s
};

/// Reads what the report journals: a heading, then a line "time,torque,torque,…" each sample.
[[nodiscard]] TorqueSeries parse_torques(const std::string& csv);

/// 8-bit BGR, 1400 pixels wide.
[[nodiscard]] cv::Mat draw_figure(const std::string& title, const std::string& subtitle, const std::vector<FigureRow>& rows,
                                  const TorqueSeries& torques, double window_s);

}  // namespace constrictor::report
