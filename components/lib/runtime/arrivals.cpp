#include "runtime/arrivals.hpp"

#include <bit>
#include <cerrno>
#include <ctime>

namespace constrictor {

Arrivals::Arrivals() { ::sem_init(&ended_, 0, 0); }

Arrivals::~Arrivals() { ::sem_destroy(&ended_); }

// No wake-up is lost: a thread that notes a sample first stores it and then looks whether it is wanted, and wait()
// first stores what it wants and then looks what has arrived. All these operations have one order (seq_cst), so at
// least one of the two threads sees what the other one has stored.

void Arrivals::note(std::size_t source) {
  Counted& counted = counted_.at(source);
  const std::uint64_t noted = ++counted.noted;
  const Sources bit = Sources{1} << source;
  arrived_ |= bit;
  if ((wanted_ & bit) == 0 || noted < counted.enough) return;
  if (wanted_.exchange(0) != 0) ::sem_post(&ended_);
}

void Arrivals::wake() {
  arrived_ |= kWoken;
  if (wanted_.exchange(0) != 0) ::sem_post(&ended_);
}

Arrivals::Sources Arrivals::that_matter(Sources wanted) const {
  Sources found = arrived_ & wanted;
  for (Sources left = found & ~kWoken; left != 0; left &= left - 1) {
    const auto source = static_cast<std::size_t>(std::countr_zero(left));
    if (counted_.at(source).noted < counted_.at(source).enough) found &= ~(Sources{1} << source);
  }
  return found;
}

void Arrivals::wait(std::chrono::nanoseconds bound, Sources wanted) {
  wanted |= kWoken;
  if (bound.count() <= 0 || that_matter(wanted) != 0) return;
  timespec end{};
  ::clock_gettime(CLOCK_MONOTONIC, &end);
  const std::int64_t end_ns = end.tv_nsec + bound.count();
  end.tv_sec += end_ns / 1'000'000'000;
  end.tv_nsec = end_ns % 1'000'000'000;
  wanted_ = wanted;
  if (that_matter(wanted) == 0) {
    while (::sem_clockwait(&ended_, CLOCK_MONOTONIC, &end) != 0 && errno == EINTR) {}
  }
  wanted_ = 0;
  // A thread that has seen wanted_ may post now or later: then the next wait() returns once for nothing.
  while (::sem_trywait(&ended_) == 0) {}
}

Arrivals::Sources Arrivals::take() {
  const Sources found = arrived_.exchange(0) & ~kWoken;
  for (Sources left = found; left != 0; left &= left - 1) {
    Counted& counted = counted_.at(static_cast<std::size_t>(std::countr_zero(left)));
    counted.at_take = counted.noted;
    counted.enough = 0;
  }
  return found;
}

void Arrivals::expect(std::size_t source, std::uint64_t samples) {
  counted_.at(source).enough = counted_.at(source).at_take + samples;
}

}  // namespace constrictor
