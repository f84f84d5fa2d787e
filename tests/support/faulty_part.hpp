// A component that writes something else than it should, or reads something else than it was sent: for tests that must
// find such faults. The component itself is not changed.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "barrier/topic_ops.hpp"
#include "component/component.hpp"

namespace constrictor::testing {

/// What is wrong with a part. Both functions change a message of the topic, and return false if it gets lost.
struct PartFault {
  std::function<bool(const TopicInfo& topic, void* message)> writes;
  std::function<bool(const TopicInfo& topic, void* message, std::int64_t tick)> reads;
  int late_ticks = 0;      ///< by which everything that the part writes is late
  bool never_old = false;  ///< what the part has read never seems to become older
  bool forgets = false;    ///< it begins anew after each start of its process
  std::shared_ptr<bool> restarted = std::make_shared<bool>(false);  ///< this process continues the run of another one
};

/// The message if it is one of this topic, otherwise null.
template <class T>
T* as(const Topic<T>& wanted, const TopicInfo& topic, void* message) {
  return topic.id == wanted.id ? static_cast<T*>(message) : nullptr;
}

/// For PartFault::writes and PartFault::reads: passes each message of one topic to `change`, which returns false if the
/// message gets lost, or nothing.
template <class T, class Change>
auto changing(const Topic<T>& wanted, Change change) {
  return [wanted, change](const TopicInfo& topic, void* message, auto...) mutable {
    T* const found = as(wanted, topic, message);
    if (found == nullptr) return true;
    if constexpr (std::is_void_v<decltype(change(*found))>) {
      change(*found);
      return true;
    } else {
      return change(*found);
    }
  };
}

/// Lies between a component and its real wiring.
class FaultyPartWiring final : public Wiring {
 public:
  FaultyPartWiring(Wiring& real, PartFault fault) : real_(real), fault_(std::move(fault)) {}
  void request_end_of_run() override { real_.request_end_of_run(); }
  void count_refusal(const std::string& reason) override { real_.count_refusal(reason); }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    const OutputSlot* slot = real_.output_slot(topic);
    OutputSlot& faulty = outputs_.emplace_back();
    faulty.topic = slot->topic;
    faulty.write = [this, slot](const void* message) {
      Sample copy = topic_ops(slot->topic->id).copy(message);
      if (fault_.writes && !fault_.writes(*slot->topic, const_cast<void*>(copy.message.get()))) return;
      if (fault_.late_ticks > 0) waiting_.push_back({now_ + fault_.late_ticks, slot, std::move(copy)});
      else slot->write(copy.message.get());
    };
    return &faulty;
  }
  const InputSlot* input(const TopicInfo& topic, bool events) override {
    const InputSlot* slot = real_.input(topic, events);
    if (!fault_.reads && !fault_.never_old) return slot;
    auto& [real, faulty] = inputs_.emplace_back(slot, *slot);
    return &faulty;
  }
  /// Before a step of the component.
  void present(const Tick& tick) {
    now_ = tick.index;
    for (auto& [real, faulty] : inputs_) {
      faulty.now_tick = real->now_tick;
      faulty.fresh.clear();
      for (const Sample& sample : real->fresh) {
        Sample copy = topic_ops(real->topic->id).copy(sample.message.get());
        const bool kept =
            !fault_.reads || fault_.reads(*real->topic, const_cast<void*>(copy.message.get()), tick.index);
        if (!kept) continue;
        faulty.fresh.push_back(copy);
        faulty.latest = copy;
      }
      if (fault_.never_old && faulty.latest.message) const_cast<msg::Header*>(faulty.latest.header)->tick = tick.index;
    }
  }
  /// After a step of the component.
  void flush() {
    while (!waiting_.empty() && waiting_.front().tick <= now_) {
      waiting_.front().slot->write(waiting_.front().sample.message.get());
      waiting_.pop_front();
    }
  }

 private:
  struct Waiting {
    std::int64_t tick;
    const OutputSlot* slot;
    Sample sample;
  };
  Wiring& real_;
  PartFault fault_;
  std::deque<OutputSlot> outputs_;  // deques, because components keep the addresses
  std::deque<std::pair<const InputSlot*, InputSlot>> inputs_;
  std::deque<Waiting> waiting_;
  std::int64_t now_ = 0;
};

class FaultyPart final : public Component {
 public:
  FaultyPart(Wiring& real, const Setup& setup, const ComponentFactory& inner, PartFault fault)
      : forgets_(fault.forgets),
        restarted_(fault.restarted),
        wiring_(real, std::move(fault)),
        inner_(inner.create(wiring_, setup)) {}
  [[nodiscard]] Timing timing() const override { return inner_->timing(); }
  void step(const Tick& tick) override {
    wiring_.present(tick);
    inner_->step(tick);
    wiring_.flush();
  }
  [[nodiscard]] std::string save() const override { return inner_->save(); }
  void load(const std::string& bytes) override {
    *restarted_ = true;
    if (!forgets_) inner_->load(bytes);
  }

 private:
  bool forgets_;
  std::shared_ptr<bool> restarted_;
  FaultyPartWiring wiring_;  // before the component, which points to its ports
  std::unique_ptr<Component> inner_;
};

/// `make`: the fault of a newly constructed component, so that its memory begins anew with each epoch.
inline ComponentFactory faulty(ComponentFactory inner, std::function<PartFault()> make) {
  ComponentFactory factory = inner;
  factory.create = [inner = std::move(inner), make = std::move(make)](Wiring& wiring, const Setup& setup) {
    return std::make_unique<FaultyPart>(wiring, setup, inner, make());
  };
  return factory;
}

}  // namespace constrictor::testing
