// Ctrl-C: signals that only set a flag, so that a command can leave the run in a defined state before it ends.
#pragma once

#include <csignal>
#include <initializer_list>

namespace constrictor {

/// From now on these signals only set a flag.
void catch_interrupts(std::initializer_list<int> signals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT});
/// Number of the last such signal; 0: none.
[[nodiscard]] int interrupt_signal();
/// Exit status of a command that was ended by a signal.
[[nodiscard]] inline int interrupt_status() { return 128 + interrupt_signal(); }

/// From now on, writing to a pipe that nobody reads any more is an error and does not kill this process: `run | tee
/// log` must end in order also if Ctrl-C has ended `tee`. Processes that it starts have the default action.
void survive_closed_pipes();

}  // namespace constrictor
