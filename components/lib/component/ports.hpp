// Typed ports: how a component's step sees its inputs and hands over its outputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "constrictor/topics.hpp"

namespace constrictor {

class ClientRequests;
class HardwareLink;
class StopOrders;

/// A message of any topic, immutable and shared. `header` points to the message's own header.
struct Sample {
  std::shared_ptr<const void> message;
  const msg::Header* header = nullptr;
};

/// The runtime's side of an input: what is visible at the present step.
struct InputSlot {
  const TopicInfo* topic = nullptr;
  bool events = false;        ///< the component wants every sample, not only the newest
  Sample latest;              ///< newest visible sample; empty before the first
  std::vector<Sample> fresh;  ///< became visible since the previous step, oldest first (Latest ports: at most one)
  std::int64_t now_tick = 0;  ///< tick of the present step
};

/// The runtime's side of an output. `write` deep-copies, stamps and queues a message given by address.
struct OutputSlot {
  const TopicInfo* topic = nullptr;
  std::function<void(const void* message)> write;
};

/// The newest visible sample of a topic. Before the first sample has_value() is false.
template <class T>
class Latest {
 public:
  Latest() = default;
  explicit Latest(const InputSlot* slot) : slot_(slot) {}
  [[nodiscard]] bool has_value() const { return slot_->latest.message != nullptr; }
  explicit operator bool() const { return has_value(); }
  [[nodiscard]] const T& operator*() const { return *static_cast<const T*>(slot_->latest.message.get()); }
  [[nodiscard]] const T* operator->() const { return &**this; }
  /// The sample; null before the first.
  [[nodiscard]] const T* get() const { return static_cast<const T*>(slot_->latest.message.get()); }
  /// Ticks since the step that wrote the sample (plant samples have age 0 in their own tick).
  [[nodiscard]] std::int64_t age_ticks() const { return slot_->now_tick - slot_->latest.header->tick; }
  /// True if the sample became visible since the previous step.
  [[nodiscard]] bool fresh() const { return !slot_->fresh.empty(); }

 private:
  const InputSlot* slot_ = nullptr;
};

/// Every sample that became visible since the previous step, oldest first.
template <class T>
class Events {
 public:
  class iterator {
   public:
    explicit iterator(const Sample* at) : at_(at) {}
    const T& operator*() const { return *static_cast<const T*>(at_->message.get()); }
    iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator!=(const iterator& other) const { return at_ != other.at_; }

   private:
    const Sample* at_;
  };
  Events() = default;
  explicit Events(const InputSlot* slot) : slot_(slot) {}
  [[nodiscard]] iterator begin() const { return iterator(slot_->fresh.data()); }
  [[nodiscard]] iterator end() const { return iterator(slot_->fresh.data() + slot_->fresh.size()); }
  [[nodiscard]] std::size_t size() const { return slot_->fresh.size(); }
  [[nodiscard]] bool empty() const { return slot_->fresh.empty(); }

 private:
  const InputSlot* slot_ = nullptr;
};

/// A topic that this component writes. The runtime fills robot_id and header, and copies the message before write
/// returns (a sequence may point into the caller's own memory).
template <class T>
class Output {
 public:
  Output() = default;
  explicit Output(const OutputSlot* slot) : slot_(slot) {}
  void write(const T& message) const { slot_->write(&message); }

 private:
  const OutputSlot* slot_ = nullptr;
};

/// Given to a component's constructor to declare its ports. Each topic at most once in each direction.
class Wiring {
 public:
  virtual ~Wiring() = default;
  template <class T>
  [[nodiscard]] Latest<T> latest(const Topic<T>& topic) {
    return Latest<T>(input(topic, false));
  }
  template <class T>
  [[nodiscard]] Events<T> events(const Topic<T>& topic) {
    return Events<T>(input(topic, true));
  }
  template <class T>
  [[nodiscard]] Output<T> output(const Topic<T>& topic) {
    return Output<T>(output_slot(topic));
  }
  /// The latch of clients' requests, for the one component that takes them (`input`). Null if no client can reach it.
  [[nodiscard]] virtual std::shared_ptr<ClientRequests> client_requests() { return nullptr; }
  /// The latch of emergency stops, for the plant. Null if no client can reach it.
  [[nodiscard]] virtual std::shared_ptr<StopOrders> stop_orders() { return nullptr; }
  /// The latch of a process outside the barrier that drives the joints, for the plant that relays to it. Null if no
  /// such process can be reached.
  [[nodiscard]] virtual std::shared_ptr<HardwareLink> hardware_link() { return nullptr; }
  /// Counts a refusal by the component in ComponentStatus; `reason` names what was found and what is accepted.
  virtual void count_refusal(const std::string& reason) { static_cast<void>(reason); }
  /// Asks the conductor to end the run when the outputs of this step become visible.
  virtual void request_end_of_run() = 0;

  // The typed functions above call these. They are public so that one wiring can wrap another.
  virtual const InputSlot* input(const TopicInfo& topic, bool events) = 0;
  virtual const OutputSlot* output_slot(const TopicInfo& topic) = 0;
};

}  // namespace constrictor
