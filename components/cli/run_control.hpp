// Commands that steer a run from outside: its time (pause, resume, step, pace, reset) and its safety (stop, clear-stop, release).
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Adds the subcommands; the chosen one puts what is to be done into `action`, which returns an exit status.
void add_run_control(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
