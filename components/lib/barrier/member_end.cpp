// The part of Member that ends it after the final tick, and names the input for which it waits.
#include <algorithm>

#include "barrier/member.hpp"
#include "component/concluding.hpp"
#include "component/device_owner.hpp"

namespace constrictor {

void Member::release_device() {
  if (auto* owner = dynamic_cast<DeviceOwner*>(component_.get())) owner->release_device();
}

void Member::conclude(const msg::Tick final_tick) {
  release_device();
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
  if (!concludes_at_) return;
  resumed_ = false;
  conclude(*concludes_at_);
}

MissingInput Member::missing() const {
  if (concludes_at_) {
    for (const auto& input : inputs_) {
      if (!input->complete_again()) return {last_done_, &input->topic(), input->newest(), input->consumed()};
    }
  }
  const msg::Tick* tick = due();
  if (!tick) return {newest_tick_ + 1, nullptr, 0, 0};
  for (const auto& input : inputs_) {
    if (input->complete(*tick)) continue;
    return {tick->index, &input->topic(), input->newest(), tick->visible[input->topic().id]};
  }
  return {tick->index, nullptr, 0, 0};
}

}  // namespace constrictor
