// Makes the image of an ideal pin-hole camera from that of a real one.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "video/calibration.hpp"

namespace constrictor::video {

/// The pixel of the camera `real`, in its distorted image, that shows what the pixel `pixel` shows in the image of the
/// pin-hole camera `ideal`. Pixels are (u, v), with pixel centres at +0.5.
[[nodiscard]] Eigen::Vector2d distorted(const CameraCalibration& real, const CameraCalibration& ideal,
                                        const Eigen::Vector2d& pixel);

class Rectifier {
 public:
  /// `calibration`: of the camera. `width`, `height` [pixel]: of the images that are made; 0: as calibrated. Throws
  /// std::invalid_argument if their proportions differ from those of the calibration.
  Rectifier(CameraCalibration calibration, int width, int height);

  /// The model of the images that are made; it has no distortion.
  [[nodiscard]] const CameraCalibration& model() const { return model_; }

  /// An RGB image from a BGR image of any size with the proportions of the calibration. The result is valid until the
  /// next call. Throws std::invalid_argument if the image has other proportions or another type.
  const cv::Mat& rectify(const cv::Mat& bgr);

 private:
  void prepare(cv::Size size);

  CameraCalibration calibration_;
  CameraCalibration model_;
  std::optional<cv::Size> prepared_;  ///< size of the images for which the maps hold
  bool same_ = false;                 ///< nothing needs to be moved
  cv::Mat map_x_, map_y_;             ///< [pixel] for each pixel, the place in the source, whole numbers at the centres
  cv::Mat moved_, rgb_;
};

}  // namespace constrictor::video
