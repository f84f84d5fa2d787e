// From an image to percepts: the pure logic of the perception component.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"
#include "perception/perception_config.hpp"

namespace constrictor::perception {

/// What is wrong with an image or its camera model; empty: nothing.
[[nodiscard]] std::string image_error(const msg::CameraImage& image, const msg::CameraInfo& info);

struct Percepts {
  msg::LinePercept line{};
  msg::ObjectPercepts objects{};
  cv::Mat picture;  ///< RGB, the dimmed image with what was found
};

/// Finds the line, objects and zones of an image by the camera's model. Holds tables only: the result depends on nothing
/// but the arguments of `detect`.
class LineAndBlobDetector {
 public:
  explicit LineAndBlobDetector(const PerceptionConfig& config);

  /// `rgb`: CV_8UC3 of the camera's size. exposure_tick and headers of the percepts stay for the caller to fill.
  [[nodiscard]] Percepts detect(const cv::Mat& rgb, const GroundCamera& camera, std::uint8_t line_colour) const;

  [[nodiscard]] const PerceptionConfig& config() const { return config_; }

 private:
  PerceptionConfig config_;
  ColourClassifier classifier_;
};

}  // namespace constrictor::perception
