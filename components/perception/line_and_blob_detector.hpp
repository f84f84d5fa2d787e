// From an image to percepts: the pure logic of the perception component.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"
#include "perception/ground_colour.hpp"
#include "perception/object_sizes.hpp"
#include "perception/perception_config.hpp"
#include "perception/regions.hpp"
#include "perception/smoothing.hpp"

namespace constrictor::perception {

/// The mistake in an image or in its camera model; empty if there is none.
[[nodiscard]] std::string image_error(const msg::CameraImage& image, const msg::CameraInfo& info);

struct Percepts {
  msg::LinePercept line{};
  msg::ObjectPercepts objects{};
  ObjectSizes measured{};  ///< the sizes of objects that this image shows
  GroundColour ground{};   ///< what this image and earlier ones have shown of the ground
  cv::Mat picture;  ///< RGB, the dimmed image with the percepts drawn into it; valid until the next call of `detect`
};

/// Finds the line, the objects and the zones in an image, by the camera's model. It keeps tables, and memory that it
/// uses again: the result depends on the arguments of `detect` alone.
class LineAndBlobDetector {
 public:
  explicit LineAndBlobDetector(const PerceptionConfig& config);

  /// Changes percepts before they are drawn into the picture.
  using Change = std::function<void(msg::LinePercept&, msg::ObjectPercepts&)>;

  /// `rgb`: CV_8UC3 of the camera's size. `seen_sizes`, `seen_ground`: what earlier images have shown. The caller fills
  /// in exposure_tick and the headers of the percepts.
  [[nodiscard]] Percepts detect(const cv::Mat& rgb, const GroundCamera& camera, std::uint8_t line_colour,
                                const ObjectSizes& seen_sizes = {}, const Change& change = {},
                                const GroundColour& seen_ground = {});

  [[nodiscard]] const PerceptionConfig& config() const { return config_; }

 private:
  PerceptionConfig config_;
  ColourClassifier classifier_;
  // Overwritten by each call of `detect`.
  Smoother smoother_;
  cv::Mat smooth_, picture_;
  Labels labels_;
  RegionBuffers region_buffers_;
  Regions regions_;
};

}  // namespace constrictor::perception
