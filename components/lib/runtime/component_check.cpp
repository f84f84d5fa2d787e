#include "runtime/component_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <set>

#include "barrier/history_depth.hpp"
#include "component/client_requests.hpp"
#include "component/data_path.hpp"
#include "component/device_owner.hpp"
#include "component/hardware_link.hpp"
#include "component/mission.hpp"
#include "component/object_bounds.hpp"

namespace constrictor {
namespace {

/// Ports without a run: inputs stay empty, and written messages are discarded.
class UnconnectedWiring : public Wiring {
 public:
  void request_end_of_run() override {}
  std::shared_ptr<ClientRequests> client_requests() override {
    takes_requests = true;
    return std::make_shared<ClientRequests>();
  }
  std::shared_ptr<HardwareLink> hardware_link() override {
    relays_hardware = true;
    return std::make_shared<HardwareLink>();
  }
  const InputSlot* input(const TopicInfo& topic, bool events) override {
    hello.reads.insert(topic.id);
    InputSlot& slot = inputs_.emplace_back();
    slot.topic = &topic;
    slot.events = events;
    return &slot;
  }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    hello.writes.insert(topic.id);
    return &outputs_.emplace_back(OutputSlot{&topic, [](const void*) {}});
  }

  Hello hello;  ///< the announcement of the component: name, timing and topics

  bool takes_requests = false;
  bool relays_hardware = false;

 private:
  std::deque<InputSlot> inputs_;  // a deque, because its elements keep the addresses that components store
  std::deque<OutputSlot> outputs_;
};

}  // namespace

namespace {

Setup setup_of(const HostOptions& options, const ComponentFactory& factory) {
  Setup setup = options.setup;
  setup.component = factory.name;
  setup.output_dir.clear();
  const auto chosen = options.config_files.find(factory.name);
  if (chosen != options.config_files.end()) setup.config_file = chosen->second;
  else if (!factory.default_config.empty()) setup.config_file = data_path(factory.default_config);
  return setup;
}

/// What the components that were built say of the objects of the mission.
class ObjectSizes {
 public:
  void ask(const Component& component, const std::string& mission) {
    if (const auto* holder = dynamic_cast<const ObjectHolder*>(&component)) bound_m_ = holder->largest_radius_m();
    const auto* source = dynamic_cast<const ObjectSource*>(&component);
    if (const auto read = source ? parse_mission(mission) : std::nullopt)
      largest_ = source->largest_object(read->sequence);
  }
  /// Why the robot cannot hold all objects; nothing: it can, or these components do not know.
  [[nodiscard]] std::optional<std::string> violation(const HostOptions& options) const {
    if (!largest_ || !bound_m_ || largest_->radius_m <= *bound_m_) return std::nullopt;
    return fmt::format(
        "{}: {}: found {:.3f} m with seed {}, accepted at most {:.3f} m: the robot can hold no larger object, and "
        "mission.sequence demands this one",
        options.setup.scenario_file.string(), largest_->key, largest_->radius_m, options.setup.seed, *bound_m_);
  }

 private:
  std::optional<DemandedObject> largest_;
  std::optional<double> bound_m_;
};

}  // namespace

std::vector<std::string> topics_of_components(const HostOptions& options,
                                              const std::vector<ComponentFactory>& factories) {
  std::vector<std::string> lines;
  for (const auto& factory : factories) {
    UnconnectedWiring wiring;
    static_cast<void>(factory.create(wiring, setup_of(options, factory)));
    for (const auto& topic : topics::kInfos) {
      if (wiring.hello.reads.contains(topic.id)) lines.push_back(fmt::format("reads {}", topic.name));
      if (wiring.hello.writes.contains(topic.id)) lines.push_back(fmt::format("writes {}", topic.name));
    }
    if (wiring.takes_requests) lines.push_back(fmt::format("reads {}", barrier_topics::kRequest.name));
    if (!wiring.relays_hardware) continue;
    for (const auto& topic : barrier_topics::kInfos) {
      if (std::string_view(topic.writers) == "hardware") lines.push_back(fmt::format("reads {}", topic.name));
    }
    lines.push_back(fmt::format("writes {}", barrier_topics::kHardwareJointCommand.name));
  }
  return lines;
}

std::string pace_violation(const HostOptions& options, const Component& plant) {
  const auto* owner = dynamic_cast<const DeviceOwner*>(&plant);
  if (options.realtime || !owner || !owner->needs_real_time()) return {};
  return fmt::format(
      "--pace: found a run that does not follow the wall clock, accepted `real_time: true` in the manifest, or --pace "
      "realtime: {} drives a device that cannot be faster than the clock",
      options.plant);
}

std::vector<std::string> check_components(const HostOptions& options, const std::vector<ComponentFactory>& factories) {
  std::vector<std::string> errors;
  std::set<std::string> reported;
  std::vector<Hello> hellos;
  ObjectSizes sizes;
  for (const auto& factory : factories) {
    Setup setup = setup_of(options, factory);
    try {
      UnconnectedWiring wiring;
      const auto component = factory.create(wiring, setup);
      const auto latency = options.latency_ticks.find(factory.name);
      if (factory.name == options.plant) {
        if (auto why = pace_violation(options, *component); !why.empty()) errors.push_back(std::move(why));
      }
      sizes.ask(*component, setup.mission);
      wiring.hello.component = factory.name;
      wiring.hello.timing = component->timing();
      if (latency != options.latency_ticks.end())
        wiring.hello.timing.latency = std::max(wiring.hello.timing.latency, latency->second);
      hellos.push_back(wiring.hello);
    } catch (const std::exception& error) {
      if (reported.insert(error.what()).second) errors.push_back(factory.name + ": " + error.what());
    }
  }
  if (auto why = sizes.violation(options)) errors.push_back(std::move(*why));
  if (auto why = depth_violation(hellos, options.plant)) errors.push_back(std::move(*why));
  return errors;
}

}  // namespace constrictor
