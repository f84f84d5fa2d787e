// The paper's input layer: the one member that listens to planners and operators.
#pragma once

#include <memory>

#include "input/arbiter.hpp"
#include "input/outside_requests.hpp"
#include "runtime/component.hpp"

namespace constrictor {

struct InputState {
  ArbiterState arbiter;
  std::uint64_t last_goal = 0;      ///< last goal started, as on task/command
  std::uint64_t running_goal = 0;   ///< the same until it is cancelled; 0: none
  std::uint8_t running_task = msg::kTaskNone;
  std::int64_t last_authority_tick = -1;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(arbiter, last_goal, running_goal, running_task, last_authority_tick);
  }
};

/// Reads planner/request and, if connected, what came from outside; writes task/command and authority. Outside requests are ruled
/// on first, in the order of OutsideRequests::latch, then the planner's in the order of their sequence numbers. At most three
/// task commands a tick are forwarded, so that a cancel always finds room; the rest is refused and counted. A planner request
/// older than a second is refused as stale.
class Input : public StatefulComponent<InputState> {
 public:
  Input(Wiring& wiring, const Setup& setup, std::shared_ptr<OutsideRequests> outside = nullptr);
  void step(const Tick& tick) override;

 private:
  /// Carries out a ruling; true if authority changed, something was refused or forwarded.
  bool obey(const Ruling& ruling, const msg::Request& request);
  void cancel_running();
  void publish_authority(const Tick& tick);

  Events<msg::Request> planner_requests_;
  Output<msg::TaskCommand> command_;
  Output<msg::Authority> authority_;
  std::shared_ptr<OutsideRequests> outside_;
  int commands_left_ = 0;
};

/// `outside`: where requests from outside the run come in; null: none do.
ComponentFactory make_input_factory(std::shared_ptr<OutsideRequests> outside = nullptr);

}  // namespace constrictor
