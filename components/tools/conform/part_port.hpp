// How the checks see a part that is a member of a run: one tick at a time, with the messages of its surroundings in and
// its own messages out. Implementations: a run over DDS (exchange_port.hpp), and runs without DDS in tests.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "barrier/topic_ops.hpp"
#include "conform/tick_period.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"

namespace constrictor::conform {

using constrictor::text_of;  // of the texts in messages, beside that of results

/// The part or the run has ended; what() contains the reason.
struct PartGone : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A message of any topic.
struct Letter {
  std::size_t topic = 0;
  Sample sample;
};

class PartPort {
 public:
  PartPort() = default;
  PartPort(const PartPort&) = delete;
  PartPort& operator=(const PartPort&) = delete;
  virtual ~PartPort() = default;

  /// The surroundings write this message in the next tick. The runtime fills in its header.
  template <class T>
  void send(const Topic<T>& topic, const T& message) {
    outgoing_.push_back({topic.id, topic_ops(topic.id).copy(&message)});
  }
  /// Makes one tick. Throws PartGone.
  void advance() {
    arrived_.clear();
    exchange(std::exchange(outgoing_, {}));
  }
  /// The messages that the part wrote, and those that became visible in the last tick, oldest first. Valid until the
  /// next advance().
  template <class T>
  [[nodiscard]] std::vector<const T*> written(const Topic<T>& topic) const {
    std::vector<const T*> messages;
    for (const Letter& letter : arrived_) {
      if (letter.topic == topic.id) messages.push_back(static_cast<const T*>(letter.sample.message.get()));
    }
    return messages;
  }
  /// Index of the last tick; -1 before the first.
  [[nodiscard]] std::int64_t tick() const { return tick_; }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }

  /// Begins a new epoch, and goes on until it has begun. Throws PartGone if none begins.
  virtual void begin_epoch() = 0;
  /// Number of messages that the part has refused so far (ComponentStatus.refused_count). The number may be some ticks
  /// old: call this kStatusTicks after the messages whose refusal is counted.
  [[nodiscard]] virtual std::uint64_t refused() = 0;
  /// Kills the part's process, and has it started again; the next tick waits for it. Returns why that cannot be done;
  /// empty: it is being done.
  [[nodiscard]] virtual std::string restart() = 0;
  /// How often the part's process has been started, from 1. The number may be old, as that of refused().
  [[nodiscard]] virtual std::uint32_t incarnation() = 0;
  static constexpr int kStatusTicks = 120;  ///< a member reports its status every 50 ticks

 protected:
  /// Makes a tick in which the surroundings write `outgoing`; fills in arrived_, tick_ and epoch_.
  virtual void exchange(std::vector<Letter> outgoing) = 0;
  std::vector<Letter> arrived_;
  std::int64_t tick_ = -1;
  std::uint32_t epoch_ = 0;

 private:
  std::vector<Letter> outgoing_;
};

}  // namespace constrictor::conform
