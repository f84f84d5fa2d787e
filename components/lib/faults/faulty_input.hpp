// One input of a component behind the faults of its topic.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "faults/fault_plan.hpp"

namespace constrictor {

class FaultyInput {
 public:
  /// `real`: the input with every sample (as events); it must outlive this object. `events`: the component wants every
  /// sample, not only the newest. `faults`: those of the topic. `seed`: of plan and run together.
  FaultyInput(const InputSlot* real, bool events, std::vector<TopicFault> faults, std::uint64_t seed);
  FaultyInput(const FaultyInput&) = delete;  // ports point to slot()
  FaultyInput& operator=(const FaultyInput&) = delete;

  [[nodiscard]] const InputSlot* slot() const { return &slot_; }
  /// Fills slot() for the step at `tick`. Calls `refuse` for each sample that a fault has made an invalid message, and
  /// gives it the reason.
  void present(const Tick& tick, const std::function<void(const std::string&)>& refuse);

  /// The state that a restarted component needs: samples that are late, frozen contents, the newest sample.
  [[nodiscard]] std::string save() const;
  /// Throws cereal::Exception or std::runtime_error if the bytes are damaged.
  void load(const std::string& bytes);

 private:
  struct Late {
    std::int64_t due;  ///< tick at which it arrives
    Sample sample;
  };
  void deliver(const Sample& sample);
  void suffer(Sample sample, const Tick& tick, const std::function<void(const std::string&)>& refuse);
  [[nodiscard]] std::uint64_t draw(const TopicFault& fault, const Sample& sample) const;

  const InputSlot* real_;
  std::vector<TopicFault> faults_;
  std::uint64_t seed_;
  InputSlot slot_;
  std::vector<Late> late_;
  std::vector<Sample> contents_;  ///< by fault: the last sample before a freeze
};

}  // namespace constrictor
