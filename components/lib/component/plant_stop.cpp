#include "component/plant_stop.hpp"

#include <algorithm>
#include <utility>

#include "constrictor/text.hpp"

namespace constrictor {
namespace {

/// Any process can send a stop under any name, and people read the name on terminals.
std::string readable(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c <= ' ' || c > '~'; }, '?');
  return name.empty() ? "?" : name;
}

}  // namespace

PlantStop::PlantStop(Wiring& wiring, std::vector<std::int64_t> planned)
    : orders_(wiring.stop_orders()),
      planned_(std::move(planned)),
      cleared_(wiring.latest(topics::kStopCleared)),
      out_(wiring.output(topics::kStopState)) {}

void PlantStop::sample(const Tick& tick) {
  StopOrders::Arrived arrived = orders_ ? orders_->take() : StopOrders::Arrived{};
  if (std::binary_search(planned_.begin(), planned_.end(), tick.index)) {
    ++arrived.count;
    arrived.source = "planned";
  }
  state_.received += arrived.count;
  if (arrived.count > 0) {
    ++state_.number;
    state_.since_tick = tick.index;
    state_.source = readable(arrived.source);
  }
  const bool stopped = in_force();
  const bool changed =
      state_.written_tick < 0 || stopped != state_.written_stopped || state_.number != state_.written_number;
  if (!changed && tick.index - state_.written_tick < kInterval_ticks) return;
  state_.written_tick = tick.index;
  state_.written_number = state_.number;
  state_.written_stopped = stopped;
  msg::StopState message{};
  message.stopped = stopped;
  message.number = state_.number;
  message.since_tick = state_.since_tick;
  set_text(message.source, state_.source);
  message.received = state_.received;
  out_.write(message);
}

bool PlantStop::in_force() {
  if (cleared_) state_.cleared = std::max(state_.cleared, cleared_->number);
  return state_.number > state_.cleared;
}

}  // namespace constrictor
