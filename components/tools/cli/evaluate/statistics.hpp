// The statistics of `constrictor evaluate`.
#pragma once

#include <cstddef>

namespace constrictor::cli {

struct Interval {
  double low = 0;
  double high = 1;
};

/// The 95 % confidence interval of a probability, after `successes` in `trials` independent trials; 0 to 1 without a
/// trial. Source: E. B. Wilson, Probable Inference, the Law of Succession, and Statistical Inference, 1927, without
/// correction for continuity.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials);

}  // namespace constrictor::cli
