// Random fields of pegs on the ground.
#pragma once

#include <cstdint>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor::peg_fields {

/// The pegs stand in a strip along the x axis of W, on which the robot starts straight with its head in the origin.
struct FieldSpec {
  double radius_m = 0.04;  ///< of a peg
  double height_m = 0.2;   ///< of a peg
  double spacing_m = 0.3;  ///< smallest distance between the axes of two pegs
  double from_m = -2.6;    ///< along x
  double to_m = 6.0;       ///< along x
  double half_width_m = 1.6;
  double friction = 0.2;  ///< between the robot and a peg
};

/// A scene with as many pegs as fit: points are drawn uniformly in the strip; each that is at least `spacing_m` away
/// from all earlier ones is kept (Poisson disk), until 5,000 draws in succession are refused. A peg that would touch
/// the straight body of the robot at the start, or be nearer to it than 0.02 m, is left out.
[[nodiscard]] Scenario draw_field(const FieldSpec& spec, double body_length_m, double body_radius_m,
                                  std::uint64_t seed);

}  // namespace constrictor::peg_fields
