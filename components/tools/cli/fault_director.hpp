// Injects the faults of processes and devices of a run (`run --faults`): decides which process gets which signal when,
// and which device which command. Pure: its owner sends them.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "faults/fault_plan.hpp"

namespace constrictor::cli {

class FaultDirector {
 public:
  using Clock = std::chrono::steady_clock;
  struct Signal {
    std::string component;
    int number;  ///< SIGKILL, SIGSTOP or SIGCONT
  };

  struct Command {
    std::string device;
    std::string line;
  };

  explicit FaultDirector(const FaultPlan& plan);

  /// For a run that is continued at this simulated time: what has happened before it is not repeated. A fault of a
  /// device that lasts begins again, because the device was started anew.
  void continue_at(double sim_time_s);
  /// The signals that are due at this simulated and wall time, each once. A fault begins when the run is seen at its
  /// time, up to 0.2 s of wall time later.
  std::vector<Signal> due(double sim_time_s, Clock::time_point now);
  /// The commands that are due at this simulated time, each once.
  std::vector<Command> commands(double sim_time_s);
  /// The faults that have begun or ended since the last call, as texts for people: "fault: drop of perception/objects
  /// begins".
  std::vector<std::string> news(double sim_time_s);

 private:
  struct Process {
    ProcessFault fault;
    bool begun = false;
    bool over = false;
    Clock::time_point end{};
  };
  struct Device {
    DeviceFault fault;
    int sent = 0;  ///< 1: the command that begins it, 2: also the one that ends it
  };
  struct Announced {
    std::string text;
    double from_s;
    double until_s;
    bool momentary = false;  ///< nothing ends it
    int said = 0;            ///< 1: that it begins, 2: that it ends
  };
  std::vector<Process> processes_;
  std::vector<Device> devices_;
  std::vector<Announced> announced_;
};

}  // namespace constrictor::cli
