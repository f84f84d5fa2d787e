// Whether a landmark still exists: evidence from images that show it, and from images that should show it and do not.
#pragma once

#include <limits>
#include <vector>

#include "constrictor/messages.hpp"
#include "guidance/guidance_config.hpp"
#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::guidance {

/// Natural logarithm of the odds that a landmark exists, after an image that shows it (`seen`), or that should show it
/// and does not. `looks`: the share of an independent look that the image counts as, 0 to 1. The result is bounded, so
/// that a landmark that was seen for a long time can be given up within seconds, too.
/// Source: Thrun, Burgard and Fox, Probabilistic Robotics, section 9.2 (log odds), with the probabilities of a
/// detection and of a false alarm as inverse sensor model.
[[nodiscard]] double updated_log_odds(const ExistenceConfig& config, double log_odds, bool seen, double looks);

/// [1] natural logarithm of the odds of this probability, which counts as at least 0.01 and at most 0.99: a percept
/// may err although it does not say so.
[[nodiscard]] double log_odds_of(double probability);

/// [1] probability of these log odds.
[[nodiscard]] double probability_of(double log_odds);

/// Something round on the ground plane, in frame V of the view at the exposure. Radius and sd in [m].
struct Disc {
  Eigen::Vector2d p{0.0, 0.0};
  double radius_m = 0.0;
  double sd_m = 0.0;  ///< standard deviation of the place
  double height_m = std::numeric_limits<double>::infinity();
};

/// The percepts of an image, and the bodies that may hide a landmark in it, at its exposure.
struct View {
  const CameraModel& camera;
  Eigen::Vector2d p_VC;  ///< of the camera above the ground plane
  /// [m] height of a further camera above the ground: what lies above or below its image is not in view, and it sees
  /// the ground beyond low screens. 0: the head's camera, which sees from existence.min_range_m to
  /// existence.max_range_m and beyond no screen.
  double height_m;
  const msg::ObjectPercepts& percepts;
  std::vector<Disc> screens;  ///< they may hide a landmark: other objects of the map, and the modules of the body
};

/// Whether the image must show a landmark of this colour at this place: it lies in the field of view with a margin that
/// contains the uncertainty of its place, is near enough, and nothing that is known lies in front of it. False in cases
/// of doubt: a blob of its colour in its direction may be it.
[[nodiscard]] bool clearly_in_view(const ExistenceConfig& config, const View& view, const Disc& landmark,
                                   std::uint8_t colour);

}  // namespace constrictor::guidance
