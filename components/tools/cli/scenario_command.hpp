// `constrictor scenario`: scenes that a seed draws, as scenario files.
#pragma once

#include <string>
#include <vector>

namespace constrictor::cli {

/// The difficulties of random scenes; sim/scenarios has a file random_NAME.yaml for each.
inline const std::vector<std::string> kDifficulties{"easy", "middle", "hard"};

}  // namespace constrictor::cli
