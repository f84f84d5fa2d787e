// The median of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace constrictor::conform {

/// The upper one of two medians. `values` must not be empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace constrictor::conform
