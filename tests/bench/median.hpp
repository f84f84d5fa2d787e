// The median of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace constrictor::bench {

/// The mean of the middle two if their number is even. `values` must not be empty.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace constrictor::bench
