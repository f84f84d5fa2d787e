// A conductor with a plant and one member, called directly.
#pragma once

#include <gtest/gtest.h>

#include "barrier/conductor.hpp"
#include "barrier_fixture.hpp"

namespace constrictor {

inline constexpr std::uint8_t kEvents = topics::kTaskEvent.id;
inline constexpr std::uint8_t kJoints = topics::kJointState.id;

class ConductorTest : public ::testing::Test {
 protected:
  static ConductorOptions options() {
    ConductorOptions options;
    options.run_id = kEpoch.run_id;
    options.roster = {"physics", "navigation"};
    options.plant = "physics";
    options.idl_hash = "idl";
    options.config_hash = "config";
    options.numeric_profile = "profile";
    return options;
  }
  static Hello hello(const std::string& component, std::uint32_t incarnation = 1) {
    Hello hello;
    hello.component = component;
    hello.incarnation = incarnation;
    hello.pid = 100 + static_cast<int>(incarnation);
    hello.host = "here";
    hello.idl_hash = "idl";
    hello.config_hash = "config";
    hello.component_hash = "own";
    hello.numeric_profile = "profile";
    hello.writes = component == "navigation" ? TopicSet::of(topics::kTaskEvent) : TopicSet::of(topics::kJointState);
    return hello;
  }
  void begin() {
    conductor_.on_hello(hello("physics"));
    conductor_.on_hello(hello("navigation"));
    conductor_.on_ready("physics", kEpoch, 1);
    conductor_.on_ready("navigation", kEpoch, 1);
  }
  /// A step of navigation at tick `index` after which it has written `count` events.
  static TickDone step(std::int64_t index, std::uint64_t count, std::uint32_t incarnation = 1) {
    TickDone done;
    done.component = "navigation";
    done.epoch = kEpoch;
    done.incarnation = incarnation;
    done.index = index;
    done.published = {{kEvents, count}};
    done.state = "state after " + std::to_string(index);
    done.written = {{kEvents, "event of " + std::to_string(index)}};
    return done;
  }
  static TickDone plant_step(std::int64_t index) {
    TickDone done;
    done.component = "physics";
    done.epoch = kEpoch;
    done.index = index;
    return done;
  }
  void tick() { conductor_.tick({{kJoints, static_cast<std::uint64_t>(conductor_.next_index() + 1)}}); }
  /// Ticks 0 to `last`, with one event in each step.
  void run_to(std::int64_t last) {
    for (std::int64_t k = conductor_.next_index(); k <= last; ++k) {
      ASSERT_TRUE(conductor_.may_tick()) << k;
      tick();
      conductor_.on_done(plant_step(k));
      conductor_.on_done(step(k, static_cast<std::uint64_t>(k + 1)));
    }
  }
  [[nodiscard]] std::string last_refusal() const {
    return record_.refusals.empty() ? "" : record_.refusals.back().second;
  }

  ConductorRecord record_;
  Conductor conductor_{options(), static_cast<ConductorSink&>(record_)};
};

}  // namespace constrictor
