// The screen of `constrictor teleop` as text. Pure: 24 lines of at most 80 columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/teleop_keys.hpp"
#include "cli/teleop_view.hpp"

namespace constrictor::cli {

struct TeleopScreen {
  std::string run;                          ///< "3 case_study"
  std::string source;                       ///< our own name
  std::optional<msg::Authority> authority;
  TeleopView view;
  TeleopDrive drive;
  std::string notice;                       ///< the last thing worth saying
  std::optional<std::string> prompt;        ///< a line being typed; empty: none is
};

std::vector<std::string> render(const TeleopScreen& screen);

}  // namespace constrictor::cli
