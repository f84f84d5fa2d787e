// Small components that mix every input into every output: an input that is lost, doubled, early or in another order
// changes all later outputs.
#pragma once

#include <cereal/types/vector.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "component/component.hpp"

namespace constrictor::testing::toys {

/// A hash of all values that were mixed into it; unit() returns it as a number in [0, 1).
struct Mixer {
  std::uint64_t value = 0x9e3779b97f4a7c15ULL;
  void mix(std::uint64_t x) {
    value = (value ^ x) * 0xbf58476d1ce4e5b9ULL;
    value ^= value >> 29;
  }
  void mix(double x) { mix(static_cast<std::uint64_t>(x * 1e15)); }
  [[nodiscard]] double unit() const { return static_cast<double>(value >> 12) * 0x1p-52; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(value);
  }
};

/// Reads JointCommand, and writes a JointState that depends on it in every tick.
class ToyPlant : public Stateful<Plant, Mixer> {
 public:
  ToyPlant(Wiring& wiring, const Setup& setup)
      : command_(wiring.latest(topics::kJointCommand)), state_out_(wiring.output(topics::kJointState)) {
    state_.mix(setup.seed);
  }
  void sample(const Tick& tick) override {
    msg::JointState state{};
    state.joint_count = 1;
    state.position_rad[0] = state_.unit();
    state.velocity_rad_s[0] = tick.time_s();
    state_out_.write(state);
  }
  void step(const Tick&) override {
    if (command_) {
      state_.mix(command_->position_rad[0]);
      state_.mix(static_cast<std::uint64_t>(command_.age_ticks()));
    }
    state_.mix(std::uint64_t{1});
  }
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }
  [[nodiscard]] double value() const { return state_.unit(); }

 private:
  Latest<msg::JointCommand> command_;
  Output<msg::JointState> state_out_;
};

/// A component whose state begins with its seed.
class Toy : public StatefulComponent<Mixer> {
 public:
  Toy(Wiring& wiring, const Setup& setup) : wiring_(wiring) { state_.mix(setup.component_seed()); }

 protected:
  Wiring& wiring_;
};

/// Reads JointState, and writes two TaskEvents in each step: readers with an Events port must see both.
class ToyNavigation : public Toy {
 public:
  ToyNavigation(Wiring& wiring, const Setup& setup, Timing timing) : Toy(wiring, setup), timing_(timing) {}
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override {
    state_.mix(joints_->position_rad[0]);
    state_.mix(static_cast<std::uint64_t>(tick.elapsed));
    for (int i = 0; i < 2; ++i) {
      msg::TaskEvent event{};
      event.goal_id = state_.value >> 1;
      events_.write(event);
      state_.mix(std::uint64_t{7});
    }
  }

 private:
  Latest<msg::JointState> joints_ = wiring_.latest(topics::kJointState);
  Output<msg::TaskEvent> events_ = wiring_.output(topics::kTaskEvent);
  Timing timing_;
};

/// Reads JointState and every TaskEvent, and writes JointCommand.
class ToyControl : public Toy {
 public:
  using Toy::Toy;
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick&) override {
    state_.mix(joints_->position_rad[0]);
    for (const auto& event : events_) state_.mix(event.goal_id);
    msg::JointCommand command{};
    command.joint_count = 1;
    command.position_rad[0] = state_.unit();
    command_.write(command);
  }

 private:
  Latest<msg::JointState> joints_ = wiring_.latest(topics::kJointState);
  Events<msg::TaskEvent> events_ = wiring_.events(topics::kTaskEvent);
  Output<msg::JointCommand> command_ = wiring_.output(topics::kJointCommand);
};

/// Reads the outputs of navigation and control, and writes a topic that no other toy reads.
class ToyPlanner : public Toy {
 public:
  using Toy::Toy;
  [[nodiscard]] Timing timing() const override { return {1, 1}; }
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick&) override {
    for (const auto& event : events_) state_.mix(event.goal_id);
    if (command_) state_.mix(command_->position_rad[0]);
    msg::MissionStatus mission{};
    mission.recoveries = static_cast<std::uint16_t>(state_.value >> 48);
    mission_.write(mission);
  }

 private:
  Events<msg::TaskEvent> events_ = wiring_.events(topics::kTaskEvent);
  Latest<msg::JointCommand> command_ = wiring_.latest(topics::kJointCommand);
  Output<msg::MissionStatus> mission_ = wiring_.output(topics::kMissionStatus);
};

inline ComponentFactory plant() {
  return {"physics",
          [](Wiring& w, const Setup& s) -> std::unique_ptr<Component> { return std::make_unique<ToyPlant>(w, s); }};
}
inline ComponentFactory navigation(Timing timing = {1, 1}) {
  return {"navigation", [timing](Wiring& w, const Setup& s) -> std::unique_ptr<Component> {
            return std::make_unique<ToyNavigation>(w, s, timing);
          }};
}
inline ComponentFactory control() {
  return {"control",
          [](Wiring& w, const Setup& s) -> std::unique_ptr<Component> { return std::make_unique<ToyControl>(w, s); }};
}
inline ComponentFactory planner() {
  return {"planner",
          [](Wiring& w, const Setup& s) -> std::unique_ptr<Component> { return std::make_unique<ToyPlanner>(w, s); }};
}

}  // namespace constrictor::testing::toys
