// Medians and quantiles. A quantile is either one of the values, which is fast and does for measured times, or is
// interpolated between its neighbours, as statistics do.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace constrictor {

/// The upper one of two medians. Reorders `values`, which must not be empty.
[[nodiscard]] inline double upper_median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value below which the share `q` (0 to 1) of the values lies, without interpolation: the lower neighbour. NaN if
/// there is no value. Reorders the values.
[[nodiscard]] inline double lower_quantile(std::span<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The value below which the share `q` (0 to 1) of the values lies, interpolated linearly between neighbours; NaN if
/// there is no value. The values need not be sorted.
[[nodiscard]] inline double interpolated_quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double at = std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace constrictor
