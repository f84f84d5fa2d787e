// The emergency stop of a plant: it holds the posture whatever the other components do, also if `input` hangs.
#pragma once

#include <cereal/types/string.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "component/component.hpp"

namespace constrictor {

/// Stops that clients have ordered since the plant's last tick. Any thread adds; the plant takes them at a tick.
class StopOrders {
 public:
  struct Arrived {
    std::uint64_t count = 0;
    std::string source;  ///< of the newest order
    template <class Archive>
    void serialize(Archive& archive) {
      archive(count, source);
    }
  };
  void add(const std::string& source) {
    const std::lock_guard lock(mutex_);
    ++arrived_.count;
    arrived_.source = source;
  }
  /// The orders that the plant has not taken. A successor of its process must know them: their senders have been told
  /// that the plant has received them.
  [[nodiscard]] Arrived waiting() const {
    const std::lock_guard lock(mutex_);
    return arrived_;
  }
  void restore(Arrived waiting) {
    const std::lock_guard lock(mutex_);
    arrived_ = std::move(waiting);
  }
  [[nodiscard]] Arrived take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(arrived_, {});
  }

 private:
  mutable std::mutex mutex_;
  Arrived arrived_;
};

/// The memory of a plant's stop. Serialisable.
struct PlantStopState {
  std::uint64_t number = 0;      ///< stops that were latched in this epoch, at most one for each tick
  std::uint64_t received = 0;    ///< orders in this epoch
  std::uint64_t cleared = 0;     ///< number of the newest stop that `input` has cleared
  std::int64_t since_tick = -1;  ///< tick at which the newest one was latched
  std::int64_t written_tick = -1;
  std::uint64_t written_number = 0;
  bool written_stopped = false;
  std::string source;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(number, received, cleared, since_tick, written_tick, written_number, written_stopped, source);
  }
};

/// A member of every plant. A stop is latched at a tick and published with that tick, on `emergency_stop/state`, so
/// that a run which is given the same ticks as `planned` repeats it bit for bit. It stays in force until `input` clears
/// it by its number; a stop that arrives meanwhile has a higher number and stays in force.
class PlantStop {
 public:
  static constexpr std::int64_t kInterval_ticks = 50;  ///< between two messages, if nothing changes
  /// `planned`: ticks at which the plant stops by itself, rising.
  explicit PlantStop(Wiring& wiring, std::vector<std::int64_t> planned = {});
  /// To be called in Plant::sample(): latches what has arrived, and publishes the state.
  void sample(const Tick& tick);
  /// To be called in Plant::step(), after the inputs have changed. While it returns true the plant holds its posture.
  [[nodiscard]] bool in_force();

  [[nodiscard]] const PlantStopState& state() const { return state_; }
  void restore(const PlantStopState& state) { state_ = state; }

 private:
  std::shared_ptr<StopOrders> orders_;  ///< null: no client can reach the plant
  std::vector<std::int64_t> planned_;
  PlantStopState state_;
  Latest<msg::StopCleared> cleared_;
  Output<msg::StopState> out_;
};

}  // namespace constrictor
