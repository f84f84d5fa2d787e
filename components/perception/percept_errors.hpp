// Errors that are added to percepts as an experiment: how do missions end if perception is worse than it is? They
// use what perception itself knows, and no ground truth.
#pragma once

#include <cstdint>

#include "configuration/parameter_set.hpp"
#include "constrictor/messages.hpp"
#include "perception/ground_camera.hpp"

namespace constrictor::perception {

/// The parameters `error.*`. The defaults change nothing.
struct PerceptErrorConfig : ParameterSet {
  double missed_share = add(missed_share, "missed_share", 0.0, "", {0.0, 1.0}, kWhileRunning,
                            "Share of the time in which an object or zone in view is not detected");
  double missed_line_share = add(missed_line_share, "missed_line_share", 0.0, "", {0.0, 1.0}, kWhileRunning,
                                 "Share of the time in which the line in view is not detected");
  double false_share = add(false_share, "false_share", 0.0, "", {0.0, 1.0}, kWhileRunning,
                           "Share of the time in which an object is detected that does not exist");
  double range_factor = add(range_factor, "range_factor", 1.0, "", {0.5, 2.0}, kWhileRunning,
                            "Factor on all distances on the ground, as if the camera's height were wrong");
  double range_noise = add(range_noise, "range_noise", 0.0, "", {0.0, 0.5}, kWhileRunning,
                           "Standard deviation of the ranges of objects and zones, as a share of the range");
  double line_noise_m = add(line_noise_m, "line_noise_m", 0.0, "m", {0.0, 0.5}, kWhileRunning,
                            "Standard deviation of the lateral position of the line");
  double lasts_s = add(lasts_s, "lasts_s", 0.1, "s", {0.02, 60.0}, kWhileRunning,
                       "Time for which a random error stays the same; the default is that of one image");

  /// Whether any error is switched on.
  [[nodiscard]] bool any() const;
};

/// The errors of the percepts of one image. They are a pure function of the arguments: of the seed, the time of the
/// exposure, and a random stream for each error. Time is divided into intervals of `lasts_s`; each error is drawn once
/// for each interval, so that errors may be made as brief as an image or as lasting as a stain on the lens.
class PerceptErrors {
 public:
  /// `seed`: of the component.
  PerceptErrors(const PerceptErrorConfig& config, std::uint64_t seed) : config_(config), seed_(seed) {}

  /// Changes the percepts of an image that was exposed at `exposure_s` with the camera `camera`. `yaw_rad`: of the head
  /// as measured by the IMU; an object that does not exist keeps its direction while the head turns.
  void apply(double exposure_s, double yaw_rad, const GroundCamera& camera, msg::LinePercept& line,
             msg::ObjectPercepts& objects) const;

 private:
  void miss(std::uint64_t interval, msg::LinePercept& line, msg::ObjectPercepts& objects) const;
  void shift(std::uint64_t interval, msg::LinePercept& line, msg::ObjectPercepts& objects) const;
  void invent(std::uint64_t interval, double yaw_rad, const GroundCamera& camera, msg::ObjectPercepts& objects) const;

  PerceptErrorConfig config_;
  std::uint64_t seed_;
};

}  // namespace constrictor::perception
