// How the operating system treats a process that must keep time: before others, without paging, on certain processors.
#pragma once

#include <string>
#include <vector>

namespace constrictor {

struct Scheduling {
  int priority = 0;          ///< 1 to 99: of the real-time scheduler SCHED_FIFO; 0: the usual scheduler
  bool lock_memory = false;  ///< pages that have been used once stay in memory
  std::vector<int> cpus;     ///< numbers of the processors that the process may use; empty: all
};

/// Reads a list of processors as `taskset` does: "0,2-3". Throws std::invalid_argument with what was found and what is
/// accepted.
[[nodiscard]] std::vector<int> parse_cpus(const std::string& text);
/// The list as text that parse_cpus() reads: "0,2,3".
[[nodiscard]] std::string cpus_text(const std::vector<int>& cpus);

/// Asks the operating system for this treatment of the calling thread and of the threads that it starts from now on, so
/// that it is called at the start of main(). Returns why something is not allowed, and what would allow it; what is
/// allowed is applied anyway.
[[nodiscard]] std::vector<std::string> apply(const Scheduling& wanted);

/// The treatment of the calling thread, for people: "FIFO 5, memory locked, CPUs 0,2"; "usual" if nothing is special.
[[nodiscard]] std::string scheduling_in_force();

}  // namespace constrictor
