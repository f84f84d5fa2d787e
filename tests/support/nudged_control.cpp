// nudged_control [control] OPTIONS: the component `control`, but it adds one ulp to the setpoint of one joint at one
// tick ($CONSTRICTOR_NUDGE_TICK, default 1000). Tests use it to prove that such a small change alters the state hash.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "control/control.hpp"
#include "control_main.hpp"

namespace {

using namespace constrictor;

// A yaw joint in the middle of the body. It moves while the robot drives. One ulp above a setpoint of exactly 0 would
// be too small to have an effect.
constexpr std::size_t kJoint = 10;

/// Passes everything through to the real wiring, and changes JointCommand at one tick.
class NudgingWiring : public Wiring {
 public:
  NudgingWiring(Wiring& inner, std::int64_t tick) : inner_(inner), tick_(tick) {}
  void request_end_of_run() override { inner_.request_end_of_run(); }
  const InputSlot* input(const TopicInfo& topic, bool events) override {
    const InputSlot* slot = inner_.input(topic, events);
    if (topic.id == topics::kJointState.id) joints_ = slot;
    return slot;
  }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    const OutputSlot* slot = inner_.output_slot(topic);
    if (topic.id != topics::kJointCommand.id) return slot;
    nudged_.topic = slot->topic;
    nudged_.write = [this, slot](const void* message) {
      auto command = *static_cast<const msg::JointCommand*>(message);
      if (joints_ && joints_->now_tick == tick_) {
        command.position_rad[kJoint] =
            std::nextafter(command.position_rad[kJoint], std::numeric_limits<double>::infinity());
      }
      slot->write(&command);
    };
    return &nudged_;
  }

 private:
  Wiring& inner_;
  std::int64_t tick_;
  const InputSlot* joints_ = nullptr;
  OutputSlot nudged_;
};

/// The component `control` with a NudgingWiring in place of its wiring.
class NudgedControl : public Component {
 public:
  NudgedControl(Wiring& wiring, const Setup& setup, std::int64_t tick)
      : wiring_(wiring, tick), control_(make_control_factory().create(wiring_, setup)) {}
  [[nodiscard]] Timing timing() const override { return control_->timing(); }
  void step(const Tick& tick) override { control_->step(tick); }
  [[nodiscard]] std::string save() const override { return control_->save(); }
  void load(const std::string& bytes) override { control_->load(bytes); }

 private:
  NudgingWiring wiring_;
  std::unique_ptr<Component> control_;
};

}  // namespace

int main(int argc, char** argv) {
  const char* text = std::getenv("CONSTRICTOR_NUDGE_TICK");
  const std::int64_t tick = text ? std::atoll(text) : 1000;
  return testing::control_main(argc, argv,
                               {"control",
                                [tick](Wiring& wiring, const Setup& setup) -> std::unique_ptr<Component> {
                                  return std::make_unique<NudgedControl>(wiring, setup, tick);
                                },
                                make_control_factory().default_config});
}
