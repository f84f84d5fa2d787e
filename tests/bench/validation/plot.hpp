// Line plots, drawn with OpenCV in the style of the figure of a run.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace constrictor::validation {

enum class Mark { kLine, kDots, kLineWithDots };

struct Series {
  std::string name;  ///< in the key; series with an empty name are not in it
  std::vector<double> x;
  std::vector<double> y;  ///< as long as x
  Mark mark = Mark::kLine;
};

/// One panel. The axes end at round numbers around all points.
struct Plot {
  std::string title;
  std::string x_label;  ///< with unit
  std::string y_label;
  std::vector<Series> series;
  bool from_zero = true;  ///< the y axis contains 0
};

/// One or several panels, two in a row. `file` is the name of its PNG file.
struct Figure {
  std::string title;
  std::string file;
  std::vector<Plot> plots;
};

/// The figure, 8 bits, red first, without gaps between its rows.
[[nodiscard]] cv::Mat draw(const Figure& figure);

}  // namespace constrictor::validation
