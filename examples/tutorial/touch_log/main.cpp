// touch_log: a component that logs when the robot begins and ends to push against something.
#include <cmath>
#include <memory>

#include "component/component.hpp"
#include "runtime/component_main.hpp"

namespace {

using namespace constrictor;

/// The whole memory of the component: a restarted process continues from it.
struct TouchLogState {
  bool touching = false;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(touching);
  }
};

class TouchLog : public StatefulComponent<TouchLogState> {
 public:
  TouchLog(Wiring& wiring, const Setup& setup) : contacts_(wiring.latest(topics::kContactState)), log_(setup.log) {}

  void step(const Tick& tick) override {
    if (!contacts_) return;  // no message has arrived yet
    double largest_n = 0;
    std::size_t module = 0;
    for (std::size_t i = 0; i < contacts_->module_count; ++i) {
      const msg::Vector3& force_n = contacts_->force_n[i];
      const double sideways_n = std::hypot(force_n.x, force_n.y);  // the weight on the ground points upwards
      if (sideways_n > largest_n) largest_n = sideways_n, module = i;
    }
    // Two limits, so that a force between them does not log a line at every tick.
    if (!state_.touching && largest_n > 2.0) {
      log_.info("module {} pushes with {:.1f} N at {:.2f} s", module, largest_n, tick.time_s());
      state_.touching = true;
    } else if (state_.touching && largest_n < 0.5) {
      log_.info("free at {:.2f} s", tick.time_s());
      state_.touching = false;
    }
  }

 private:
  Latest<msg::ContactState> contacts_;
  Log log_;
};

}  // namespace

int main(int argc, char** argv) {
  return component_main(argc, argv, {"touch_log", [](Wiring& wiring, const Setup& setup) {
                                       return std::make_unique<TouchLog>(wiring, setup);
                                     }});
}
