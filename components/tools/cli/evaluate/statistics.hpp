// The statistics of `constrictor evaluate`.
#pragma once

#include <cstddef>
#include <vector>

namespace constrictor::cli {

struct Interval {
  double low = 0;
  double high = 1;
};

/// The 95 % confidence interval of a probability, after `successes` in `trials` independent trials; 0 to 1 without a
/// trial. Source: E. B. Wilson, Probable Inference, the Law of Succession, and Statistical Inference, 1927, without
/// correction for continuity.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials);

/// The value below which the share `q` (0 to 1) of the values lies, interpolated linearly between neighbours; NaN if
/// there is no value. The values need not be sorted.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace constrictor::cli
