// The screen of `constrictor teleop` as text. Pure: no terminal, no DDS.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/teleop_keys.hpp"
#include "cli/teleop_view.hpp"
#include "common/screen_size.hpp"

namespace constrictor::cli {

/// The smallest screen that shows the authority, the commanded motion, the notice and the emergency-stop key.
inline constexpr ScreenSize kSmallestScreen{40, 10};

struct TeleopScreen {
  std::string run;     ///< "3 case_study"
  std::string source;  ///< this program's source name
  std::optional<msg::Authority> authority;
  TeleopView view;
  TeleopDrive drive;
  std::string notice;                 ///< the answer to the last request
  std::optional<std::string> prompt;  ///< a task that is being typed; empty: none
};

/// At most `size.rows` lines of at most `size.columns` printable characters. The least important lines are left out
/// first; the key of the emergency stop is always shown. If the terminal is smaller than kSmallestScreen, a message
/// names the required size.
std::vector<std::string> render(const TeleopScreen& screen, ScreenSize size = {});

}  // namespace constrictor::cli
