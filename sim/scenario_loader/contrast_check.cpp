#include "sim/scenario_loader/contrast_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "constrictor/constants.hpp"
#include "sim/scenario_loader/reflectance.hpp"

namespace constrictor {
namespace {

/// Perception tells tints that differ by 0.045 apart; the rest is for noise, and for the mixed colours of edges.
constexpr double kLeastDifference = 0.07;

/// The shares of red, green and blue in a pixel, in neutral light of any strength. The display's gamma is a square
/// root. Black has the shares of grey.
Eigen::Vector3d shares(const Eigen::Vector3d& reflectance) {
  const Eigen::Vector3d shown = reflectance.cwiseMax(1e-6).cwiseSqrt();
  return shown / shown.sum();
}

}  // namespace

void check_contrast(const Configuration& root, const Eigen::Vector3d& ground, bool has_line, const Mission& mission) {
  const auto check = [&](std::uint8_t colour, const std::string& what) {
    const Rgb paint = colour_reflectance(colour);
    const double difference = (shares({paint.r, paint.g, paint.b}) - shares(ground)).cwiseAbs().maxCoeff();
    if (difference >= kLeastDifference) return;
    throw root.error("ground_colour",
                     fmt::format("found [{}, {}, {}], on which the camera cannot see {} that the mission needs: the "
                                 "shares of red, green and blue differ by {:.3f}, accepted a ground whose shares "
                                 "differ by at least {} from those of {} paint",
                                 ground.x(), ground.y(), ground.z(), what, difference, kLeastDifference,
                                 name_of(constants::kColour, colour)));
  };
  if (has_line) check(mission.line_colour, "the line");
  for (const std::uint8_t colour : mission.sequence)
    check(colour, fmt::format("the {} zone", name_of(constants::kColour, colour)));
}

}  // namespace constrictor
