#include "runtime/links.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <utility>

#include "cyclone/acknowledgements.hpp"
#include "cyclone/create_domain.hpp"

namespace constrictor {

Links::Links(std::uint32_t domain, const std::string& identity)
    : domain_(
          (dds::Mailbox::open_for_this_process(), dds::create_domain(domain, dds::Reach::kLoopback, dds::kNoLinger))),
      participant_(dds::create_participant(domain, dds::Reach::kLoopback, identity)) {}

void Links::wake() { arrivals_.wake(); }

void Links::attach(dds_entity_t reader, std::function<void()> take, Wakes wakes) {
  const std::size_t source = attached_.size();
  if (source == Arrivals::kMost) throw std::logic_error("a process has too many readers");
  attached_.push_back({reader, std::move(take), {&arrivals_, source}});
  if (wakes == Wakes::kAlways) always_ |= Arrivals::Sources{1} << source;
  // The reader keeps its other callbacks.
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(nullptr),
                                                                            dds_delete_listener);
  dds::check(dds_get_listener(reader, listener.get()), "dds_get_listener");
  const auto note = [](dds_entity_t, void* to) {
    const auto& place = *static_cast<const Place*>(to);
    place.arrivals->note(place.source);
  };
  dds::check(dds_lset_data_available_arg(listener.get(), note, &attached_.back().place, true),
             "dds_lset_data_available_arg");
  dds::check(dds_set_listener(reader, listener.get()), "dds_set_listener");
  arrivals_.note(source);  // samples may have arrived before
}

void Links::take_all() {
  for (const auto& one : attached_) one.take();
}

void Links::expect(dds_entity_t reader, std::size_t samples) {
  const auto one = std::find_if(attached_.begin(), attached_.end(),
                                [reader](const Attached& attached) { return attached.reader == reader; });
  if (one != attached_.end()) arrivals_.expect(one->place.source, samples);
}

void Links::let_receiver_turn(std::function<bool()> turn) {
  turn_ = std::move(turn);
  active_ = std::unique_lock(active_mutex_);
  before_waiting_.emplace([this] { turn_in_receiver(); });
}

void Links::want(bool wanted) {
  if (wanted && !emptied_at_once_) emptied_at_once_.emplace();
  else if (!wanted) emptied_at_once_.reset();
  mattering_ = wanted ? ~Arrivals::Sources{0} : always_;
}

void Links::take_arrived() {
  for (Arrivals::Sources found = arrivals_.take(); found != 0; found &= found - 1)
    attached_[static_cast<std::size_t>(std::countr_zero(found))].take();
}

// No sample is left: a thread that finds the mutex locked leaves what has arrived to the other thread, which looks for
// it after it has unlocked the mutex.
void Links::turn_in_receiver() {
  receiver_turns_ = true;
  while (arrivals_.has(mattering_)) {
    const std::unique_lock active(active_mutex_, std::try_to_lock);
    if (!active || thrown_) return;
    try {
      take_arrived();
      if (turn_()) arrivals_.wake();
    } catch (...) {
      thrown_ = std::current_exception();
      arrivals_.wake();
    }
  }
}

void Links::wait(dds_duration_t bound_ns, bool wanted) {
  want(wanted);
  const std::chrono::nanoseconds bound(bound_ns);
  if (receiver_turns_) {
    active_.unlock();
    if (!arrivals_.has(mattering_)) arrivals_.wait(bound, 0);
    active_.lock();
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  } else {
    arrivals_.wait(bound, mattering_);
  }
  take_arrived();
}

}  // namespace constrictor
