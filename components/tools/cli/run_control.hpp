// Commands for the time of a run (pause, resume, step, pace, reset) and for its safety (stop, clear-stop, release).
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Adds the subcommands; the chosen one sets `action` to a function that returns the exit status.
void add_run_control(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
