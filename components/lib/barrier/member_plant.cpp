// The part of Member that only the plant uses: it measures at the instant of a tick.
#include <cstdio>
#include <cstdlib>

#include "barrier/member.hpp"

namespace constrictor {

PlantCheckpoint Member::measure(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns) {
  if (!epoch_ || !is_plant_) {
    std::fprintf(stderr, "constrictor: bug in component %s: measured before the epoch, or is no plant\n",
                 name().c_str());
    std::abort();
  }
  stamp_ = {epoch_->run_id, epoch_->epoch, incarnation_, index, time_ns, 0};
  for (auto& port : outputs_) port->in_this_step = 0;
  fresh_component_ = false;
  measuring_ = true;
  static_cast<Plant&>(*component_).sample(Tick{index, time_ns, period_ns, 1, epoch_->run_id, epoch_->epoch});
  measuring_ = false;
  if (!checkpoints_) return {};
  PlantCheckpoint checkpoint{state_bytes({}), std::move(written_)};
  written_.clear();
  written_.reserve(outputs_.size());
  return checkpoint;
}

void Member::publish_sample() {
  for (const auto& [topic, sample] : sample_) sink_.publish(*topic, sample);
  sample_.clear();
}

void Member::sample_plant(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns) {
  measure(index, time_ns, period_ns);
  publish_sample();
}

}  // namespace constrictor
