// The ticks of a run, seen from outside: for tests that have to wait until the run has gone on.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/wire.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace constrictor::testing {

class RunTicks {
 public:
  /// Of the run that this launcher has started.
  explicit RunTicks(Process& launcher)
      : domain_(domain_of(launcher)),
        ticks_(dds::Reader<msg::Tick>::observer(domain_.participant(), barrier_topics::kTick)) {}

  /// Waits until the run has made `count` ticks more. False if it has not within the bound of eventually().
  [[nodiscard]] bool pass(std::int64_t count) {
    ticks_.take([](const msg::Tick&) {});
    std::optional<std::int64_t> begin, now;
    return eventually([&] {
      ticks_.take([&](const msg::Tick& tick) { now = tick.index; });
      if (!begin || (now && *now < *begin)) begin = now;
      return now && *now - *begin >= count;
    });
  }

  /// Waits until the run has made no tick for 0.5 s. False if it goes on within the bound of eventually().
  [[nodiscard]] bool stand() {
    auto changed = std::chrono::steady_clock::now();
    return eventually([&] {
      ticks_.take([&](const msg::Tick&) { changed = std::chrono::steady_clock::now(); });
      return std::chrono::steady_clock::now() - changed > std::chrono::milliseconds(500);
    });
  }

  /// For more readers in this process.
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }

 private:
  dds::Domain domain_;
  dds::Reader<msg::Tick> ticks_;
};

}  // namespace constrictor::testing
