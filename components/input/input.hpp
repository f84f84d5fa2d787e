// The paper's input layer: the one member that listens to planners and operators.
#pragma once

#include "input/arbiter.hpp"
#include "runtime/component.hpp"

namespace constrictor {

struct InputState {
  ArbiterState arbiter;
  std::uint64_t running_goal = 0;   ///< last goal forwarded
  std::uint8_t running_task = 0;
  std::int64_t last_authority_tick = -1;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(arbiter, running_goal, running_task, last_authority_tick);
  }
};

/// Reads planner/request; writes task/command and authority. Requests are ruled on in the order of their sequence numbers;
/// at most four task commands a tick are forwarded, the rest is refused and counted.
class Input : public StatefulComponent<InputState> {
 public:
  Input(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;

 private:
  /// Rules on one request; true if authority changed or something was refused.
  bool rule(const msg::Request& request);
  void cancel_running();
  void publish_authority(const Tick& tick);

  Events<msg::Request> planner_requests_;
  Output<msg::TaskCommand> command_;
  Output<msg::Authority> authority_;
  int commands_left_ = 0;
};

ComponentFactory make_input_factory();

}  // namespace constrictor
