#include "client/run_attachment.hpp"

namespace constrictor {

void RunAttachment::look(const RunSigns& signs, Clock::time_point now) {
  if (!over_.empty()) return;
  if (!run_id_) run_id_ = signs.run_id;
  if (signs.states_heard != states_heard_) {
    states_heard_ = signs.states_heard;
    heard_ = now;
  }
  silent_s_ = states_heard_ == 0 ? 0.0 : std::chrono::duration<double>(now - heard_).count();

  had_input_ = had_input_ || signs.input;
  if (!had_input_ || signs.input) input_gone_.reset();
  else if (!input_gone_) input_gone_ = now;

  if (signs.run_id && signs.run_id != run_id_) over_ = "the run has ended: another one has started in its DDS domain";
  else if (!signs.launcher || signs.plant_ended) over_ = "the run has ended";
  else if (input_gone_ && now - *input_gone_ >= kInputGrace) over_ = "`input` is gone and was not restarted";
}

}  // namespace constrictor
