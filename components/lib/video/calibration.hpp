// The calibration of a camera: its lens and its mount, as a YAML file.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor::video {

/// Pin-hole model with the distortion of Brown and Conrady, as OpenCV has it. Pixel centres lie at +0.5 and the origin
/// is the top left corner of the image, as in CameraInfo. OpenCV's own pixel centres lie at whole numbers: its
/// principal point is smaller by 0.5.
struct CameraCalibration {
  int width = 0;                                  ///< [pixel] of the images for which the model holds
  int height = 0;                                 ///< [pixel]
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< [pixel]
  std::vector<double> distortion{};               ///< k1 k2 p1 p2, then k3, then k4 k5 k6: 0, 4, 5 or 8 numbers
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();  ///< camera in the head
  std::optional<double> reprojection_error_px{};           ///< root mean square, as the calibration found it

  /// The same camera with images of another size. Throws std::invalid_argument if the proportions differ.
  [[nodiscard]] CameraCalibration scaled_to(int new_width, int new_height) const;
};

/// The camera as the robot file describes it: no distortion.
[[nodiscard]] CameraCalibration calibration_of(const CameraModel& camera);

/// Reads a calibration file; README.md has its keys. A file without `mount` gets the mount of `camera`. Throws
/// ConfigurationError.
[[nodiscard]] CameraCalibration load_calibration(const std::filesystem::path& file, const CameraModel& camera);

/// The content of a calibration file. `made_by`: for the comment in its first line. `mounted`: whether it has a mount.
[[nodiscard]] std::string calibration_text(const CameraCalibration& calibration, bool mounted,
                                           const std::string& made_by);

}  // namespace constrictor::video
