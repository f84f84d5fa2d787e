// The ticks of a run, seen from outside: for tests that have to wait until the run has gone on.
#pragma once

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
        ticks_(dds::Reader<msg::Tick>::observer(domain_.participant(), dds::barrier_topics::kTick)) {}

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

  /// For more readers in this process.
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }

 private:
  dds::Domain domain_;
  dds::Reader<msg::Tick> ticks_;
};

}  // namespace constrictor::testing
