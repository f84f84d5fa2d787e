// From an image to percepts: the pure logic of the perception component.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"
#include "perception/perception_config.hpp"

namespace constrictor::perception {

/// The mistake in an image or in its camera model; empty if there is none.
[[nodiscard]] std::string image_error(const msg::CameraImage& image, const msg::CameraInfo& info);

struct Percepts {
  msg::LinePercept line{};
  msg::ObjectPercepts objects{};
  cv::Mat picture;  ///< RGB, the dimmed image with the percepts drawn into it
};

/// Finds the line, the objects and the zones in an image, by the camera's model. It keeps tables only: the result
/// depends on the arguments of `detect` alone.
class LineAndBlobDetector {
 public:
  explicit LineAndBlobDetector(const PerceptionConfig& config);

  /// `rgb`: CV_8UC3 of the camera's size. The caller fills in exposure_tick and the headers of the percepts.
  [[nodiscard]] Percepts detect(const cv::Mat& rgb, const GroundCamera& camera, std::uint8_t line_colour) const;

  [[nodiscard]] const PerceptionConfig& config() const { return config_; }

 private:
  PerceptionConfig config_;
  ColourClassifier classifier_;
};

}  // namespace constrictor::perception
