// From an image to percepts: the pure logic of the perception component.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "perception/colour_classifier.hpp"
#include "perception/glare.hpp"
#include "perception/ground_camera.hpp"
#include "perception/ground_colour.hpp"
#include "perception/line_fit.hpp"
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
  MeasuredSizes measured{};  ///< the sizes of objects that this image shows
  GroundColour ground{};     ///< what this image and earlier ones have shown of the ground
};

/// Finds the line, the objects and the zones in an image, by the camera's model. It keeps tables, and memory that it
/// uses again: what `detect` finds depends on its arguments alone.
class LineAndBlobDetector {
 public:
  explicit LineAndBlobDetector(const PerceptionConfig& config);

  /// `rgb`: CV_8UC3 of the camera's size. `seen_sizes`, `seen_ground`: what earlier images have shown. The caller fills
  /// in exposure_tick and the headers of the percepts.
  [[nodiscard]] Percepts detect(const cv::Mat& rgb, const GroundCamera& camera, std::uint8_t line_colour,
                                const ObjectSizes& seen_sizes = {}, const GroundColour& seen_ground = {});

  /// Draws percepts of the image that `detect` has seen last. `rgb`, `camera`: the same as then. Returns RGB, the
  /// dimmed image with the percepts drawn into it, which is valid until the next call.
  [[nodiscard]] const cv::Mat& draw(const cv::Mat& rgb, const GroundCamera& camera, const msg::LinePercept& line,
                                    const msg::ObjectPercepts& objects);

  [[nodiscard]] const PerceptionConfig& config() const { return config_; }

 private:
  PerceptionConfig config_;
  ColourClassifier classifier_;
  // Overwritten by each call of `detect`, and the picture by each call of `draw`.
  Smoother smoother_;
  cv::Mat smooth_, picture_;
  Labels labels_;
  GlareBuffers glare_buffers_;
  TintSamples tint_samples_;
  RegionBuffers region_buffers_;
  LineFitter line_fitter_;
  Regions regions_;
};

}  // namespace constrictor::perception
