#include "cli/run_faults.hpp"

#include <chrono>

namespace constrictor::cli {

void RunFaults::poll(const RunView& view, const Supervisor& supervisor, Companions& companions,
                     const std::function<void(const std::string&)>& print) {
  if (!known_) {
    // Before its first tick is known, a run that is continued seems to stand at its begin.
    if (view.tick < 0) return;
    director_.continue_at(view.sim_time_s());
    known_ = true;
  }
  for (const auto& [component, signal] : director_.due(view.sim_time_s(), std::chrono::steady_clock::now()))
    supervisor.signal(component, signal);
  companions.obey(director_.commands(view.sim_time_s()));
  for (const auto& line : director_.news(view.sim_time_s())) print(line);
}

}  // namespace constrictor::cli
