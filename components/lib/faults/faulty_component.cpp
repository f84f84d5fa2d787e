#include "faults/faulty_component.hpp"

#include <algorithm>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <deque>
#include <stdexcept>

#include "component/concluding.hpp"
#include "component/device_owner.hpp"
#include "constrictor/archive.hpp"
#include "faults/faulty_input.hpp"

namespace constrictor {
namespace {

class FaultyWiring : public Wiring {
 public:
  FaultyWiring(Wiring& real, std::string component, const FaultPlan& plan, std::uint64_t seed)
      : real_(real), component_(std::move(component)), plan_(plan), seed_(seed) {}

  std::shared_ptr<ClientRequests> client_requests() override { return real_.client_requests(); }
  std::shared_ptr<StopOrders> stop_orders() override { return real_.stop_orders(); }
  std::shared_ptr<HardwareLink> hardware_link() override { return real_.hardware_link(); }
  void count_refusal(const std::string& reason) override { real_.count_refusal(reason); }
  void request_end_of_run() override { real_.request_end_of_run(); }
  const OutputSlot* output_slot(const TopicInfo& topic) override { return real_.output_slot(topic); }
  const InputSlot* input(const TopicInfo& topic, bool events) override {
    std::vector<TopicFault> faults;
    for (const auto& fault : plan_.topics) {
      const bool reads = fault.readers.empty() ||
                         std::find(fault.readers.begin(), fault.readers.end(), component_) != fault.readers.end();
      if (fault.topic->id == topic.id && reads) faults.push_back(fault);
    }
    if (faults.empty()) return real_.input(topic, events);
    return inputs_.emplace_back(real_.input(topic, true), events, std::move(faults), seed_).slot();
  }

  void present(const Tick& tick) {
    for (auto& input : inputs_) input.present(tick, [this](const std::string& reason) { count_refusal(reason); });
  }
  [[nodiscard]] std::vector<std::string> save() const {
    std::vector<std::string> states;
    for (const auto& input : inputs_) states.push_back(input.save());
    return states;
  }
  void load(const std::vector<std::string>& states) {
    if (states.size() != inputs_.size()) throw std::runtime_error("checkpoint of faulty inputs: of another plan");
    auto state = states.begin();
    for (auto& input : inputs_) input.load(*state++);
  }

 private:
  Wiring& real_;
  std::string component_;
  const FaultPlan& plan_;
  std::uint64_t seed_;
  std::deque<FaultyInput> inputs_;  // a deque, because its elements keep the addresses that components store
};

/// The component with its faulty inputs. `Base`: Component or Plant.
template <class Base>
class Faulty : public Base, public Concluding, public DeviceOwner {
 public:
  Faulty(std::string name, std::shared_ptr<const FaultPlan> plan, std::unique_ptr<FaultyWiring> wiring,
         std::unique_ptr<Component> inner, std::function<void(double)> wait_ms)
      : name_(std::move(name)),
        plan_(std::move(plan)),
        wiring_(std::move(wiring)),
        inner_(std::move(inner)),
        wait_ms_(std::move(wait_ms)) {}

  [[nodiscard]] Timing timing() const override { return inner_->timing(); }
  void step(const Tick& tick) override {
    wiring_->present(tick);
    for (const auto& fault : plan_->processes) {
      if (fault.kind != ProcessFault::Kind::kSlow || fault.component != name_) continue;
      // Only the wall clock is concerned: a slow computer does not compute anything else.
      if (tick.time_ns >= fault.from_ns && tick.time_ns < fault.until_ns) wait_ms_(fault.step_ms);
    }
    inner_->step(tick);
  }
  [[nodiscard]] std::string save() const override { return save_bytes(inner_->save(), wiring_->save()); }
  void load(const std::string& bytes) override {
    std::string inner;
    std::vector<std::string> inputs;
    load_bytes(bytes, inner, inputs);
    wiring_->load(inputs);
    inner_->load(inner);
  }
  void conclude(const Tick& last) override {
    if (auto* concluding = dynamic_cast<Concluding*>(inner_.get())) concluding->conclude(last);
  }
  [[nodiscard]] std::string device_status() const override {
    const auto* owner = dynamic_cast<const DeviceOwner*>(inner_.get());
    return owner ? owner->device_status() : std::string();
  }
  [[nodiscard]] bool needs_real_time() const override {
    const auto* owner = dynamic_cast<const DeviceOwner*>(inner_.get());
    return owner && owner->needs_real_time();
  }
  void release_device() override {
    if (auto* owner = dynamic_cast<DeviceOwner*>(inner_.get())) owner->release_device();
  }

 protected:
  std::string name_;
  std::shared_ptr<const FaultPlan> plan_;
  std::unique_ptr<FaultyWiring> wiring_;  // before the component, which points to its ports
  std::unique_ptr<Component> inner_;
  std::function<void(double)> wait_ms_;
};

class FaultyPlant : public Faulty<Plant> {
 public:
  using Faulty<Plant>::Faulty;
  void sample(const Tick& tick) override { static_cast<Plant&>(*inner_).sample(tick); }
  [[nodiscard]] std::int64_t period_ns() const override { return static_cast<const Plant&>(*inner_).period_ns(); }
};

}  // namespace

ComponentFactory with_faults(ComponentFactory factory, std::shared_ptr<const FaultPlan> plan,
                             std::function<void(double)> wait_ms) {
  if (!plan || (plan->topics.empty() && plan->processes.empty())) return factory;
  ComponentFactory faulty = factory;
  faulty.create = [create = std::move(factory.create), name = factory.name, plan = std::move(plan),
                   wait_ms = std::move(wait_ms)](Wiring& real, const Setup& setup) -> std::unique_ptr<Component> {
    auto wiring = std::make_unique<FaultyWiring>(real, name, *plan, plan->seed * 0x9e3779b97f4a7c15 + setup.seed);
    auto inner = create(*wiring, setup);
    if (dynamic_cast<Plant*>(inner.get()))
      return std::make_unique<FaultyPlant>(name, plan, std::move(wiring), std::move(inner), wait_ms);
    return std::make_unique<Faulty<Component>>(name, plan, std::move(wiring), std::move(inner), wait_ms);
  };
  return faulty;
}

}  // namespace constrictor
