#include "runtime/component_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <memory>
#include <set>

#include "barrier/history_depth.hpp"
#include "component/client_requests.hpp"
#include "component/data_path.hpp"
#include "component/device_owner.hpp"
#include "component/hardware_link.hpp"
#include "component/mission.hpp"
#include "component/object_bounds.hpp"
#include "component/robot_bounds.hpp"

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

/// A component without a run.
struct Built {
  std::unique_ptr<UnconnectedWiring> wiring;
  std::unique_ptr<Component> component;  // after its wiring, so that it is destroyed first
};

/// Adds the lines that `line` makes from the texts of a verdict.
template <class Line>
void add(const CheckVerdict& verdict, const Line& line, Findings& findings) {
  for (const auto& what : verdict.refusals) findings.errors.push_back(line(what));
  for (const auto& what : verdict.warnings) findings.warnings.push_back(line(what));
}

/// Whether the components that were built can deal with the objects of the mission.
class ObjectCheck {
 public:
  /// Keeps a component that knows which objects it can deal with.
  void ask(Built built, const std::string& mission) {
    const auto* source = dynamic_cast<const ObjectSource*>(built.component.get());
    if (const auto read = source ? parse_mission(mission) : std::nullopt)
      objects_ = source->demanded_objects(read->sequence);
    if (dynamic_cast<const ObjectJudge*>(built.component.get())) judges_.push_back(std::move(built));
  }
  /// Adds what is wrong with the objects; nothing if these components do not know them.
  void report(const HostOptions& options, Findings& findings) const {
    const auto line = [&](const std::string& what) {
      return fmt::format("{}: {} (seed {}; mission.sequence demands this object)", options.setup.scenario_file.string(),
                         what, options.setup.seed);
    };
    for (const DemandedObject& object : objects_) {
      for (const Built& judge : judges_) {
        add(dynamic_cast<const ObjectJudge&>(*judge.component).judge(object), line, findings);
      }
    }
  }

 private:
  std::vector<DemandedObject> objects_;
  std::vector<Built> judges_;
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

Findings check_components(const HostOptions& options, const std::vector<ComponentFactory>& factories) {
  Findings findings;
  std::set<std::string> reported;
  std::vector<Hello> hellos;
  ObjectCheck objects;
  for (const auto& factory : factories) {
    Setup setup = setup_of(options, factory);
    try {
      Built built{std::make_unique<UnconnectedWiring>(), nullptr};
      built.component = factory.create(*built.wiring, setup);
      const auto latency = options.latency_ticks.find(factory.name);
      if (factory.name == options.plant) {
        if (auto why = pace_violation(options, *built.component); !why.empty())
          findings.errors.push_back(std::move(why));
      }
      Hello hello = built.wiring->hello;
      hello.component = factory.name;
      hello.timing = built.component->timing();
      if (latency != options.latency_ticks.end())
        hello.timing.latency = std::max(hello.timing.latency, latency->second);
      hellos.push_back(std::move(hello));
      if (const auto* judge = dynamic_cast<const RobotJudge*>(built.component.get())) {
        const std::string own = factory.name + ": ";  // before what is about the configuration of the component
        const auto line = [&](const std::string& what) {
          return what.starts_with(own) ? setup.config_file.string() + ": " + what.substr(own.size())
                                       : setup.robot_file.string() + ": " + what;
        };
        add(judge->judge_robot(), line, findings);
      }
      if (const auto* judge = dynamic_cast<const SceneJudge*>(built.component.get())) {
        const auto line = [&](const std::string& what) { return setup.scenario_file.string() + ": " + what; };
        add(judge->judge_scene(), line, findings);
      }
      objects.ask(std::move(built), setup.mission);
    } catch (const std::exception& error) {
      if (reported.insert(error.what()).second) findings.errors.push_back(factory.name + ": " + error.what());
    }
  }
  objects.report(options, findings);
  if (auto why = depth_violation(hellos, options.plant)) findings.errors.push_back(std::move(*why));
  return findings;
}

}  // namespace constrictor
