// The page of an evaluation: one HTML file without scripts and without anything from the network.
#pragma once

#include <string>
#include <vector>

#include "cli/evaluate/summary.hpp"

namespace constrictor::cli {

struct PageContent {
  std::string scenario;
  std::string about;        ///< one line: options, version
  std::size_t planned = 0;  ///< runs of the whole evaluation, also those that are not done
  std::vector<Variant> variants;
  std::vector<MissionResult> results;
};

[[nodiscard]] std::string make_page(const PageContent& content);

}  // namespace constrictor::cli
