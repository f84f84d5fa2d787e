// Sliding mode control of the heading along a line, with a boundary layer. It is an alternative to the PID of
// steering.hpp; README.md compares both.
#pragma once

#include "configuration/parameter_set.hpp"
#include "navigation/steering.hpp"

namespace constrictor {

struct SlidingSteeringConfig : ParameterSet {
  double gain_1_m = add(gain_1_m, "gain_1_m", 1.0, "1/m", {0.0, 5.0}, kWhileRunning,
                        "Curvature by which the head turns towards the sliding surface, outside of the layer");
  double layer_rad = add(layer_rad, "layer_rad", 0.6, "rad", {0.01, 3.0}, kWhileRunning,
                         "Half the width of the boundary layer, within which the law is linear");
  double approach_m = add(approach_m, "approach_m", 0.6, "m", {0.1, 10.0}, kWhileRunning,
                          "On the surface, the offset of the line falls by a factor of e along this distance");
};

/// The line in an image: at `ahead_m` in front of the head its offset and its direction relative to the head, positive
/// to the left, and its curvature, which counts as constant up to there.
struct LineAhead {
  double ahead_m = 0.0;
  double offset_m = 0.0;
  double heading_rad = 0.0;
  double curvature_1_m = 0.0;
};

struct SlidingSteeringState {
  SteeringState offset, heading, curvature;  ///< of the line at the head
  template <class Archive>
  void serialize(Archive& archive) {
    archive(offset, heading, curvature);
  }
};

/// With the offset y of the line beside the head, its direction h there relative to the head, and its curvature c, the
/// head that moves at speed v on a path of curvature k has dy/dt = v sin h and dh/dt = v (c - k). The sliding variable
/// is s = h + atan(y / A), A = approach_m: on s = 0 the offset decays as exp(-distance / A) for small angles. The law
///
///     k = c + sin h / A / (1 + (y / A)^2) + gain_1_m sat(s / layer_rad)
///
/// gives ds/dt = -v gain_1_m sat(s / layer_rad). A disturbance of the curvature below gain_1_m can therefore not keep s
/// outside of the layer: s enters it within |s| / (v (gain_1_m - disturbance)), and stays. All measurements are
/// averaged over a gait period, because the head sways with the gait; this delay bounds 1 / A + gain_1_m / layer_rad.
/// Compare the guidance by line of sight of Rezapour et al., Robotics and Biomimetics 1:3, 2014.
class SlidingSteering {
 public:
  /// `limit_1_m`: bound of the curvature.
  SlidingSteering(const SlidingSteeringConfig& config, double limit_1_m) : config_(config), limit_1_m_(limit_1_m) {}
  /// Adds an image of the line, and discards those older than `period_s`. An image with a number that is not finite is
  /// ignored.
  static void observe(double time_s, const LineAhead& line, double period_s, SlidingSteeringState& state);
  /// [1/m] curvature for the present means; 0 before the first image.
  [[nodiscard]] double curvature(const SlidingSteeringState& state) const;

 private:
  const SlidingSteeringConfig& config_;
  double limit_1_m_;
};

}  // namespace constrictor
