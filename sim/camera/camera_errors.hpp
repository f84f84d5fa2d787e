// The errors of a bad camera in the images: the parameters `error.*` of the camera.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/camera/camera_config.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Whether the image of `tick` is lost. A pure function of its arguments; the images of different ticks are independent
/// of each other.
[[nodiscard]] bool image_is_dropped(double dropped_share, std::uint64_t seed, std::int64_t tick);

/// [s] instants, relative to that of the image, at which the scene is drawn and averaged for an exposure time. They are
/// spread evenly around 0; only 0 if the exposure time is 0.
[[nodiscard]] std::vector<double> exposure_instants(double exposure_s);

/// The poses at a time after `now`, if each body keeps its velocity from `before` to `now`. `share` is this time
/// divided by the time from `before` to `now`: 0 gives `now`, -1 gives `before`. Both have the same bodies.
[[nodiscard]] ScenePoses extrapolated(const ScenePoses& before, const ScenePoses& now, double share);

/// The errors of one finished image, in the order in which they arise: exposure, lens, white balance and gain,
/// contrast. It uses integers, basic arithmetic, square roots and the fixed-point Gaussian filter of OpenCV, so that
/// the bytes are the same on every processor.
class ImageErrors {
 public:
  explicit ImageErrors(const CameraErrorConfig& config) : config_(config) {}

  /// Begins an exposure that averages `frames` frames.
  void begin(std::size_t frames);
  /// Adds a drawn frame to the exposure: RGB, 8 bits; all of one size.
  void expose(const std::vector<std::uint8_t>& rgb);
  /// Whether some error would change the one frame of an exposure without motion.
  [[nodiscard]] bool change_single_frames() const;
  /// Writes the image into `rgb`, of `width` columns.
  void finish(int width, std::vector<std::uint8_t>& rgb);

 private:
  CameraErrorConfig config_;
  std::size_t frames_ = 0;
  std::vector<std::uint32_t> sums_;         // of the intensities of the frames, 0 to 255² each
  std::vector<std::uint16_t> intensities_;  // of the image, 0 to 255²
};

}  // namespace constrictor
