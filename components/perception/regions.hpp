// Connected regions of one colour in the label image, and whether they stand upright on the ground.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "perception/colour_classifier.hpp"
#include "perception/ground_camera.hpp"
#include "perception/ground_colour.hpp"
#include "perception/perception_config.hpp"

namespace constrictor::perception {

/// Ids of regions are bytes.
inline constexpr std::size_t kMaxRegions = 250;

/// Pixels of one colour that belong together. Bounds are inclusive pixel indices.
struct Region {
  std::uint8_t colour = msg::kColourUnknown;
  int area = 0;  ///< [pixel]
  int u_min = 0, v_min = 0, u_max = 0, v_max = 0;
  /// First and last column in which the region reaches above the horizon; first > last: there is none. Such a region
  /// stands upright, because flat ground never rises above the horizon. Of a low object: its first and last column.
  int standing_first = 0, standing_last = -1;
  int standing_bottom = -1;  ///< lowest row in which the standing part still has most of its width
  bool line = false;         ///< elongated on the ground and of the line's colour
  // Fields of a low object, set by mark_low_objects() or split_objects_from_zones():
  bool low = false;                        ///< stands upright although it does not reach above the horizon
  bool on_zone = false;                    ///< its foot is not seen before a zone, or ground, of the same colour
  bool doubtful = false;                   ///< too little is in view to distinguish a low object from a zone
  double left_rad = 0.0, right_rad = 0.0;  ///< azimuths of its sides
  double height_m = 0.0;
  /// By how many standard deviations the region rises above the bound between flat and upright; negative: below it.
  double rise_sd = 0.0;
  bool left_hidden = false, right_hidden = false;  ///< something, or the robot's body, hides this side

  [[nodiscard]] bool standing() const { return standing_last > standing_first; }
  /// Makes the whole region a low object between these azimuths.
  void stand_low(double left, double right, double height) {
    low = true;
    left_rad = left;
    right_rad = right;
    height_m = height;
    standing_first = u_min;
    standing_last = u_max;
    standing_bottom = v_max;
  }
};

struct Regions {
  std::vector<Region> regions;
  cv::Mat ids;  ///< CV_8UC1: 1 + index of the pixel's region, 0: none
  GroundColour ground;
  cv::Mat dazzled;  ///< labels with kDazzled; empty if no pixel has it

  /// Whether glare hides what lies at a pixel.
  [[nodiscard]] bool dazzled_at(int u, int v) const {
    return !dazzled.empty() && u >= 0 && v >= 0 && u < dazzled.cols && v < dazzled.rows &&
           dazzled.at<std::uint8_t>(v, u) == kDazzled;
  }
};

/// Images and lists that find_regions() uses again, so that it need not allocate them for each image.
struct RegionBuffers {
  struct Fragment {
    Region region;
    int component = 0;
  };
  cv::Mat mask, components, stats, centroids;
  std::vector<Fragment> fragments;
  std::vector<int> group;  ///< of each fragment
  std::vector<std::uint8_t> id_of_component, id_of_group;
  std::vector<Eigen::Vector2d> points;  ///< of a region's rows on the ground
};

/// Finds the regions of labels: joins fragments of one colour, drops specks and the fringes of mixed colour
/// between two others. The labels contain no coloured `ground`. The memory of `out` and `buffers` is used again.
void find_regions(const Labels& labels, const GroundCamera& camera, const PerceptionConfig& config,
                  std::uint8_t line_colour, const GroundColour& ground, RegionBuffers& buffers, Regions& out);

}  // namespace constrictor::perception
