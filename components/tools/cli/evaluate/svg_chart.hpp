// Charts as SVG, for the page of an evaluation.
#pragma once

#include <string>
#include <vector>

#include "cli/evaluate/statistics.hpp"

namespace constrictor::cli {

/// Colours of series that colour-blind readers can distinguish. Source: M. Okabe and K. Ito, Color Universal Design.
[[nodiscard]] const char* series_colour(std::size_t index);

struct Bar {
  std::string name;
  double value = 0;      ///< from 0 to the chart's `full`
  std::string text;      ///< behind the bar
  bool whisker = false;  ///< draw `interval`
  Interval interval{};
  std::size_t colour = 0;  ///< of series_colour()
};

/// Horizontal bars, one below the other; the axis goes from 0 to `full`. `key`: names of the colours, if there are
/// several.
[[nodiscard]] std::string bar_chart(const std::string& title, const std::vector<Bar>& bars, double full,
                                    const std::string& unit, const std::vector<std::string>& key = {});

struct CurvePoint {
  double x = 0;
  double y = 0;
  bool whisker = false;
  Interval interval{};
};

struct Curve {
  std::string name;  ///< in the key
  std::vector<CurvePoint> points;
  bool steps = false;  ///< horizontal and vertical lines only, as for a cumulative distribution
};

/// Curves over a common axis with ticks at round numbers. `y_full`: the upper end of the y axis; 0: chosen.
[[nodiscard]] std::string curve_chart(const std::string& title, const std::vector<Curve>& curves,
                                      const std::string& x_label, const std::string& y_label, double y_full = 0);

}  // namespace constrictor::cli
