// The paper's input layer: the only member that takes requests from planners and operators.
#pragma once

#include <memory>
#include <optional>

#include "component/client_requests.hpp"
#include "component/component.hpp"
#include "input/arbiter.hpp"
#include "input/parameter_arbiter.hpp"

namespace constrictor {

struct InputState {
  ArbiterState arbiter;
  std::uint64_t last_goal = 0;     ///< id of the last started goal on task/command
  std::uint64_t running_goal = 0;  ///< id of the goal that may still run; 0: none
  std::uint8_t running_task = msg::kTaskNone;
  bool moving = false;  ///< a direct motion is in force
  std::int64_t last_authority_tick = -1;
  ParameterArbiterState parameters;
  std::uint64_t plant_stops = 0;    ///< StopState.number of the newest stop of the plant that is known
  std::uint64_t cleared_stops = 0;  ///< of the newest one that was cleared
  template <class Archive>
  void serialize(Archive& archive) {
    archive(arbiter, last_goal, running_goal, running_task, moving, last_authority_tick, parameters, plant_stops,
            cleared_stops);
  }
};

/// Reads planner/request and the requests of clients; writes task/command, motion/command, parameter/change, authority,
/// and an answer to each request. The decisions on clients' requests come first, in the order of ClientRequests::latch,
/// then those on the planner's requests in the order of their sequence numbers. At most three task commands are sent in
/// a tick, so that a cancel always finds room; further ones are refused. Of several direct motions in a tick the last
/// one counts. A planner request that is older than 50 ticks is refused.
class Input : public StatefulComponent<InputState> {
 public:
  Input(Wiring& wiring, const Setup& setup, std::shared_ptr<ClientRequests> client_requests = nullptr);
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override;

 private:
  /// Obeys the decision that `decide()` returns, and answers the request.
  template <class Decide>
  void answer(const msg::Request& request, Decide&& decide);
  void obey(const Decision& decision, const msg::Request& request);
  void forward_task(const Decision& decision, const msg::Request& request);
  void forward_motion(const msg::Request& request);
  void set_parameter(const msg::Request& request);
  /// Requests the changes of input.yaml whose tick comes next; true if there were any.
  bool set_planned_parameters(const Tick& tick);
  void cancel_running();
  /// Latches a stop that the plant has latched. Returns whether there was one.
  bool follow_plant_stop();
  /// Lets the plant end its stop after an operator has cleared it.
  void clear_plant_stop();
  void publish_authority(const Tick& tick);

  Wiring& wiring_;
  Events<msg::Request> planner_requests_ = wiring_.events(topics::kPlannerRequest);
  Output<msg::TaskCommand> command_ = wiring_.output(topics::kTaskCommand);
  Output<msg::Authority> authority_ = wiring_.output(topics::kAuthority);
  Output<msg::MotionCommand> motion_out_ = wiring_.output(topics::kMotionCommand);
  Output<msg::ParameterChange> parameter_out_ = wiring_.output(topics::kParameterChange);
  Output<msg::RequestAnswer> answer_out_ = wiring_.output(topics::kRequestAnswer);
  Latest<msg::StopState> plant_stop_ = wiring_.latest(topics::kStopState);
  Output<msg::StopCleared> stop_cleared_ = wiring_.output(topics::kStopCleared);
  std::vector<Latest<msg::ParameterList>> parameters_in_;
  std::vector<PlannedChange> planned_;
  std::shared_ptr<ClientRequests> client_requests_;
  int commands_left_ = 0;                     ///< task commands that may still be sent in this step
  int changes_left_ = 0;                      ///< parameter changes that may still be sent in this step
  std::int64_t now_ = 0;                      ///< tick of the present step
  std::string clearer_;                       ///< source of the last request in this step that cleared a stop
  std::optional<msg::MotionCommand> motion_;  ///< to be written at the end of the present step
};

/// `client_requests`: where the requests of clients arrive; null: the runtime fills them from the topic `request/v2`.
ComponentFactory make_input_factory(std::shared_ptr<ClientRequests> client_requests = nullptr);

}  // namespace constrictor
