// Quantiles of measured times.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace constrictor {

/// The value below which the share `q` (0 to 1) of the values lies; NaN if there are none. Reorders the values.
[[nodiscard]] inline double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace constrictor
