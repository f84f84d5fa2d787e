// Plants and members for tests that run components in a LocalRun: made of functions instead of a class for each test.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "component/component.hpp"

namespace constrictor::testing {

/// The base of plants in tests: a control period of 20 ms, and `sample` alone decides what is measured.
class PlantBase : public Plant {
 public:
  void sample(const Tick&) override {}
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }
};

/// The step function of a member.
using StepFunction = std::function<void(const Tick&)>;
/// Declares the ports of a member, once for each epoch and incarnation, and returns its step.
using WireFunction = std::function<StepFunction(Wiring&)>;

/// A plant whose `sample` is a function.
class ScriptedPlant : public PlantBase {
 public:
  explicit ScriptedPlant(StepFunction sample) : sample_(std::move(sample)) {}
  void sample(const Tick& tick) override { sample_(tick); }

 private:
  StepFunction sample_;
};

/// A member whose step is a function. It has no state, so that it may be restarted at any tick: what the function
/// writes must follow from the tick and from its inputs.
class ScriptedMember : public Component {
 public:
  ScriptedMember(StepFunction step, Timing timing) : step_(std::move(step)), timing_(timing) {}
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override { step_(tick); }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  StepFunction step_;
  Timing timing_;
};

/// A stand-in for the plant, registered as `physics`, with this `sample`.
inline ComponentFactory scripted_plant(WireFunction wire) {
  return {"physics", [wire = std::move(wire)](Wiring& wiring, const Setup&) {
            return std::make_unique<ScriptedPlant>(wire(wiring));
          }};
}

/// A stand-in for the plant, registered as `physics`, that measures nothing.
inline ComponentFactory idle_plant() {
  return {"physics", [](Wiring&, const Setup&) { return std::make_unique<PlantBase>(); }};
}

/// A stand-in for the plant, registered as `physics`: a straight robot that stands still and touches nothing. Writes
/// JointState and ContactState.
inline ComponentFactory still_robot(std::uint16_t joint_count = 23) {
  return scripted_plant([joint_count](Wiring& wiring) -> StepFunction {
    return [joint_count, joints = wiring.output(topics::kJointState),
            contacts = wiring.output(topics::kContactState)](const Tick&) {
      msg::JointState state{};
      state.joint_count = joint_count;
      joints.write(state);
      contacts.write(msg::ContactState{});
    };
  });
}

/// A member of this name in the roster with this step.
inline ComponentFactory scripted_member(std::string name, WireFunction wire, Timing timing = {}) {
  return {std::move(name), [wire = std::move(wire), timing](Wiring& wiring, const Setup&) {
            return std::make_unique<ScriptedMember>(wire(wiring), timing);
          }};
}

/// A member that writes one topic: `write` is called at each step.
template <class T>
ComponentFactory scripted_writer(std::string name, const Topic<T>& topic,
                                 std::function<void(const Tick&, const Output<T>&)> write, Timing timing = {}) {
  return scripted_member(
      std::move(name),
      [&topic, write = std::move(write)](Wiring& wiring) -> StepFunction {
        return [write, output = wiring.output(topic)](const Tick& tick) { write(tick, output); };
      },
      timing);
}

/// The member of a class whose constructor takes Wiring and Setup.
template <class Member>
ComponentFactory member_of_class(std::string name) {
  return {std::move(name), [](Wiring& wiring, const Setup& setup) -> std::unique_ptr<Component> {
            return std::make_unique<Member>(wiring, setup);
          }};
}

}  // namespace constrictor::testing
