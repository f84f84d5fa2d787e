// Which readers have received samples, and a wait for those that matter.
#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace constrictor {

/// Sources are numbered from 0; at most kMost. One thread waits; any thread may note samples and wake it. A sample that
/// nobody waits for costs one atomic operation and no system call.
class Arrivals {
 public:
  static constexpr std::size_t kMost = 63;
  using Sources = std::uint64_t;  ///< bit i: source i

  Arrivals();
  Arrivals(const Arrivals&) = delete;
  Arrivals& operator=(const Arrivals&) = delete;
  ~Arrivals();

  /// A sample of this source has arrived.
  void note(std::size_t source);
  /// Ends the present or else the next wait().
  void wake();

  /// Whether a source of `wanted` has samples that were not taken, and that would end a wait(). Any thread may ask.
  [[nodiscard]] bool has(Sources wanted) const { return that_matter(wanted & ~kWoken) != 0; }
  /// Returns when a source of `wanted` has samples that were not taken, wake() was called, or `bound` is over.
  void wait(std::chrono::nanoseconds bound, Sources wanted);
  /// The sources that have noted samples since the last call. The caller must take the samples of all of them.
  [[nodiscard]] Sources take();
  /// Until the next take() that contains this source, its samples end a wait() only when there are `samples` more of
  /// them than at the last take().
  void expect(std::size_t source, std::uint64_t samples);

 private:
  struct Counted {
    std::atomic<std::uint64_t> noted = 0;
    std::atomic<std::uint64_t> enough = 0;  ///< number at which a wait() ends
    std::uint64_t at_take = 0;
  };
  static constexpr Sources kWoken = Sources{1} << kMost;
  /// Which of the sources that have samples end a wait() for `wanted`.
  [[nodiscard]] Sources that_matter(Sources wanted) const;

  std::atomic<Sources> arrived_ = 0;
  std::atomic<Sources> wanted_ = 0;  ///< by the wait() that goes on; 0: none does
  std::array<Counted, kMost> counted_;
  sem_t ended_{};
};

}  // namespace constrictor
