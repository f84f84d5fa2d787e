// Glare: where smooth ground reflects the light, the colours of what lies on it are paler.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"
#include "perception/ground_colour.hpp"

namespace constrictor::perception {

/// Lists that recover_pale_colours() uses again, so that it need not allocate them for each image.
struct GlareBuffers {
  std::vector<const std::uint8_t*> bright, ground;  ///< pixels
  std::vector<double> brightness, differences;
  TintSamples tints;
};

/// If an image shows glare on the ground, gives pale pixels below the horizon the colour of their hue: a reflection
/// adds white, which lowers the saturation and leaves the hue. A pixel is pale if it is as bright as the ground and has
/// another tint. Ground that is white because the camera is saturated becomes kDazzled. `rgb`: the smoothed image.
/// Returns whether a pixel is kDazzled.
bool recover_pale_colours(const cv::Mat& rgb, const ColourClassifier& classifier, const GroundCamera& camera,
                          GlareBuffers& buffers, Labels& labels);

}  // namespace constrictor::perception
