// The expectations of `constrictor conform camera`, and how it moves the camera: one row for each value.
#pragma once

#include <string>

#include "configuration/parameter_set.hpp"
#include "constrictor/constants.hpp"

namespace constrictor::conform {

struct CameraProfile : ParameterSet {
  double patience_s =
      add(patience_s, "patience_s", 10.0, "s", {0.1, 600.0}, kAtStart, "Time to wait for the first image");
  double watch_s =
      add(watch_s, "watch_s", 4.0, "s", {0.5, 60.0}, kAtStart, "Time for which images are collected at rest");
  double rate_share = add(rate_share, "rate.tolerance", 0.2, "", {0.01, 0.9}, kAtStart,
                          "Images are more or fewer than frame_period_s says by less than this share");
  double longest_gap = add(longest_gap, "rate.longest_gap", 3.5, "", {1.0, 100.0}, kAtStart,
                           "Longest time between two images, as a multiple of frame_period_s");
  double latency_s = add(latency_s, "latency.most_s", 0.3, "s", {0.0, 5.0}, kAtStart,
                         "Longest time from the exposure until the image can be read");
  double jitter_s = add(jitter_s, "latency.jitter_s", 0.1, "s", {0.0, 5.0}, kAtStart,
                        "Difference between the longest and the shortest of these times");
  double view_rad = add(view_rad, "tolerance.view_rad", 0.2, "rad", {0.01, 2.0}, kAtStart,
                        "The field of view differs from that of the robot file by less than this");
  double mount_m = add(mount_m, "tolerance.mount_m", 0.03, "m", {0.001, 0.5}, kAtStart,
                       "The place of the camera differs from that of the robot file by less than this");
  double mount_rad = add(mount_rad, "tolerance.mount_rad", 0.2, "rad", {0.005, 3.2}, kAtStart,
                         "Its direction differs from that of the robot file by less than this");
  int most_equal = add(most_equal, "most_equal", 3, "images", {1, 1000}, kAtStart, "Most equal images in a row");
  bool moves = add(moves, "motion.moves", true, "Move the head; false: the pictures do not follow the robot");
  double yaw_rad = add(yaw_rad, "motion.yaw_rad", 0.3, "rad", {0.05, 0.8}, kAtStart, "How far the head is turned");
  double pitch_rad =
      add(pitch_rad, "motion.pitch_rad", 0.15, "rad", {0.03, 0.5}, kAtStart, "How far the nose is lifted");
  double rate_rad_s = add(rate_rad_s, "motion.rate_rad_s", 0.3, "rad/s", {0.02, 2.0}, kAtStart, "How fast");
  double settle_s =
      add(settle_s, "motion.settle_s", 1.0, "s", {0.1, 10.0}, kAtStart, "Time in which head and images come to rest");
  double scale_share = add(scale_share, "tolerance.scale", 0.4, "", {0.05, 0.9}, kAtStart,
                           "The motion in the images differs from the expected one by less than this share");
  double stamp_s = add(stamp_s, "tolerance.stamp_s", 0.12, "s", {0.01, 2.0}, kAtStart,
                       "The motion in the images is earlier or later than exposure_tick says by less than this");
  std::uint8_t colour = add(colour, "line_colour", msg::kColourUnknown, names_of(constants::kColour),
                            "Colour of the line ahead; unknown: that of the scenario's mission");
};

}  // namespace constrictor::conform
