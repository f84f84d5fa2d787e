// What a component that `--check` asks finds wrong with a part of the run.
#pragma once

#include <string>
#include <vector>

namespace constrictor {

/// For people: each text states key, found, accepted and reason.
struct CheckVerdict {
  std::vector<std::string> refusals;  ///< why the mission cannot succeed
  std::vector<std::string> warnings;  ///< why it often fails
};

}  // namespace constrictor
