// `constrictor teleop`: drive the robot by hand, in a terminal or from a script.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Adds the subcommand; if it is chosen, `action` is set to a function that returns the exit status.
void add_teleop(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
