// The paper's input layer: the one member that listens to planners and operators.
#pragma once

#include <memory>
#include <optional>

#include "input/arbiter.hpp"
#include "input/parameter_desk.hpp"
#include "runtime/component.hpp"
#include "runtime/outside_requests.hpp"

namespace constrictor {

struct InputState {
  ArbiterState arbiter;
  std::uint64_t last_goal = 0;      ///< last goal started, as on task/command
  std::uint64_t running_goal = 0;   ///< the same until it is cancelled; 0: none
  std::uint8_t running_task = msg::kTaskNone;
  bool moving = false;              ///< a direct motion is in force
  std::int64_t last_authority_tick = -1;
  ParameterDeskState desk;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(arbiter, last_goal, running_goal, running_task, moving, last_authority_tick, desk);
  }
};

/// Reads planner/request and what came from outside; writes task/command, motion/command, parameter/change, authority, and an answer
/// to each request. Outside requests are ruled
/// on first, in the order of OutsideRequests::latch, then the planner's in the order of their sequence numbers. At most three
/// task commands a tick are forwarded, so that a cancel always finds room; the rest is refused and counted. Of direct motions the
/// last of a tick counts. A planner request older than a second is refused as stale.
class Input : public StatefulComponent<InputState> {
 public:
  Input(Wiring& wiring, const Setup& setup, std::shared_ptr<OutsideRequests> outside = nullptr);
  void step(const Tick& tick) override;

 private:
  /// Carries out the ruling that `decide()` makes, and answers the request.
  template <class Decide>
  void answer(const msg::Request& request, Decide&& decide);
  void obey(const Ruling& ruling, const msg::Request& request);
  void forward_task(const Ruling& ruling, const msg::Request& request);
  void forward_motion(const msg::Request& request);
  void set_parameter(const msg::Request& request);
  /// Those of input.yaml whose tick comes next; true if there were any.
  bool set_planned_parameters(const Tick& tick);
  void cancel_running();
  void publish_authority(const Tick& tick);

  Events<msg::Request> planner_requests_;
  Output<msg::TaskCommand> command_;
  Output<msg::Authority> authority_;
  Output<msg::MotionCommand> motion_out_;
  Output<msg::ParameterChange> parameter_out_;
  Output<msg::RequestAnswer> answer_out_;
  std::vector<Latest<msg::ParameterList>> parameters_in_;
  std::vector<PlannedChange> planned_;
  std::shared_ptr<OutsideRequests> outside_;
  int commands_left_ = 0;
  int changes_left_ = 0;
  std::int64_t now_ = 0;  ///< tick of the present step
  std::optional<msg::MotionCommand> motion_;  ///< of the present step
};

/// `outside`: where requests from outside the run come in; null: the runtime's own latch, fed by the topic `request`.
ComponentFactory make_input_factory(std::shared_ptr<OutsideRequests> outside = nullptr);

}  // namespace constrictor
