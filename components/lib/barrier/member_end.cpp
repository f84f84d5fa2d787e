// The part of Member that ends it after the final tick, and names the input for which it waits.
#include <algorithm>

#include "barrier/member.hpp"
#include "component/concluding.hpp"
#include "component/device_owner.hpp"

namespace constrictor {

void Member::release_device() {
  if (auto* owner = dynamic_cast<DeviceOwner*>(component_.get())) owner->release_device();
}

void Member::conclude(const msg::Tick& final_tick) {
  if (!step_) release_device();
  // A member with latency may be behind. It does its last steps, so that the result does not depend on how far.
  if (is_behind(final_tick)) concludes_at_ = final_tick;
  else finish(final_tick);
}

bool Member::is_behind(const msg::Tick& final_tick) const {
  if (final_tick.realtime) return !ticks_.empty();
  const std::int64_t last = final_tick.index - 1;  // no component steps in the final tick
  return last >= 0 && last_done_ < last - last % timing_.period;
}

void Member::finish(const msg::Tick final_tick) {
  auto* concluding = last_done_ < 0 ? nullptr : dynamic_cast<Concluding*>(component_.get());
  if (concluding && resumed_) {
    // No step of this incarnation has shown the component its inputs: they must arrive again.
    const auto complete = [](const auto& input) { return input->complete_again(); };
    if (!std::all_of(inputs_.begin(), inputs_.end(), complete)) {
      concludes_at_ = final_tick;
      return;
    }
    for (const auto& input : inputs_) input->present_again(last_done_);
  }
  ended_ = true;
  concludes_at_.reset();
  if (!concluding) return;
  const std::int64_t time_ns = final_tick.time_ns - (final_tick.index - last_done_) * final_tick.period_ns;
  concluding->conclude(Tick{last_done_, time_ns, final_tick.period_ns, 1, final_tick.run_id, final_tick.epoch});
}

void Member::conclude_anyway() {
  if (!concludes_at_ || step_) return;
  ticks_.clear();
  resumed_ = false;
  finish(*concludes_at_);
}

MissingInput Member::missing() const {
  const bool behind = concludes_at_ && is_behind(*concludes_at_);
  if (concludes_at_ && !behind) {
    for (const auto& input : inputs_) {
      if (!input->complete_again()) return {last_done_, &input->topic(), input->newest(), input->consumed()};
    }
  }
  const msg::Tick* tick = due();
  if (!tick && behind) return {last_done_ < 0 ? 0 : last_done_ + timing_.period, nullptr, 0, 0};
  if (!tick) return {newest_tick_ + 1, nullptr, 0, 0};
  for (const auto& input : inputs_) {
    if (input->complete(*tick)) continue;
    return {tick->index, &input->topic(), input->newest(), tick->visible[input->topic().id]};
  }
  return {tick->index, nullptr, 0, 0};
}

}  // namespace constrictor
