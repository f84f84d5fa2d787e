// Carries out the faults of processes and devices while a run goes on.
#pragma once

#include <functional>
#include <string>

#include "cli/companions.hpp"
#include "cli/fault_director.hpp"
#include "cli/run_observer.hpp"
#include "cli/supervisor.hpp"

namespace constrictor::cli {

class RunFaults {
 public:
  /// `resumed`: the run is continued, so that faults whose time has passed are not repeated.
  RunFaults(const FaultPlan& plan, bool resumed) : director_(plan), known_(!resumed) {}
  /// Sends the signals and commands that are due, and prints which faults have begun or ended.
  void poll(const RunView& view, const Supervisor& supervisor, Companions& companions,
            const std::function<void(const std::string&)>& print);

 private:
  FaultDirector director_;
  bool known_;  ///< the time at which the run stands is known
};

}  // namespace constrictor::cli
