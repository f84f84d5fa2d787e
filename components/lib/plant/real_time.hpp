// Asks the operating system to run a process before others.
#pragma once

#include <string>

namespace constrictor {

/// Gives the calling thread, and the threads that it starts from now on, the real-time scheduler with this priority (1
/// to 99). Returns why that is not allowed; empty: done.
[[nodiscard]] std::string prefer_this_process(int priority);

}  // namespace constrictor
