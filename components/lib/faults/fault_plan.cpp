#include "faults/fault_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "faults/message_fields.hpp"

namespace constrictor {
namespace {

constexpr double kLongest_s = 1e6;
constexpr std::size_t kPorts = 16;  // a device refuses those that it does not have

const std::vector<std::string> kTopicKinds = {"drop", "delay", "duplicate", "corrupt", "freeze", "bias"};
const std::vector<std::string> kProcessKinds = {"kill", "stop", "slow"};

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

template <class Kind>
Kind kind_of(Configuration& entry, const std::vector<std::string>& names) {
  const std::string name = entry.text("kind", names);
  return static_cast<Kind>(std::find(names.begin(), names.end(), name) - names.begin());
}

const TopicInfo& topic_of(Configuration& entry) {
  const std::string name = entry.text("topic");
  std::vector<std::string> accepted;
  for (const auto& topic : topics::kInfos) {
    if (topic.name == name) return topic;
    accepted.emplace_back(topic.name);
  }
  throw entry.error("topic", fmt::format("found {}, accepted a topic of members (see `constrictor topic list`){}", name,
                                         did_you_mean(name, accepted)));
}

/// Reads from_s and until_s; without until_s the fault lasts until the end of the run.
template <class Fault>
void read_times(Configuration& entry, Fault& fault) {
  fault.from_ns = nanoseconds(entry.number("from_s", {0, kLongest_s}, 0.0));
  fault.until_ns = std::numeric_limits<std::int64_t>::max();
  if (!entry.has("until_s")) return;
  fault.until_ns = nanoseconds(entry.number("until_s", {0, kLongest_s}));
  if (fault.until_ns <= fault.from_ns) throw entry.error("until_s", "found a time that is not after from_s");
}

TopicFault read_topic_fault(Configuration& entry) {
  TopicFault fault;
  fault.topic = &topic_of(entry);
  fault.kind = kind_of<TopicFault::Kind>(entry, kTopicKinds);
  read_times(entry, fault);
  fault.probability = entry.number("probability", {0, 1}, 1.0);
  if (fault.kind == TopicFault::Kind::kDelay)
    fault.delay_ticks = static_cast<int>(entry.integer("delay_ticks", 1, 10000));
  if (fault.kind == TopicFault::Kind::kBias) {
    fault.field = entry.text("field");
    fault.amount = entry.number("amount", {-1e9, 1e9});
    if (const auto why = not_a_real_number(fault.topic->id, fault.field)) throw entry.error("field", *why);
  }
  return fault;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

LinkFault read_link_fault(Configuration& entry, const std::vector<std::string>& roster) {
  LinkFault fault;
  fault.components = entry.texts("link", roster);
  if (fault.components.empty() ||
      std::all_of(roster.begin(), roster.end(), [&](const auto& name) { return contains(fault.components, name); }))
    throw entry.error("link", "found none or all components of the run, accepted those on one side of the link");
  static_cast<void>(entry.text("kind", {"down"}));
  read_times(entry, fault);
  return fault;
}

/// The effect of a link's fault on each topic that crosses the link.
std::vector<TopicFault> topics_across(const LinkFault& link, const std::vector<std::string>& roster) {
  std::vector<std::string> others;
  for (const auto& name : roster) {
    if (!contains(link.components, name)) others.push_back(name);
  }
  std::vector<TopicFault> faults;
  for (const auto& topic : topics::kInfos) {
    if (!contains(roster, topic.writer)) continue;
    TopicFault fault;
    fault.kind = TopicFault::Kind::kLinkDown;
    fault.topic = &topic;
    fault.from_ns = link.from_ns;
    fault.until_ns = link.until_ns;
    fault.readers = contains(link.components, topic.writer) ? others : link.components;
    faults.push_back(std::move(fault));
  }
  return faults;
}

ProcessFault read_process_fault(Configuration& entry, const std::vector<std::string>& roster) {
  ProcessFault fault;
  fault.component = entry.text("process");
  if (std::find(roster.begin(), roster.end(), fault.component) == roster.end()) {
    throw entry.error("process", fmt::format("found {}, accepted {}{}", fault.component, fmt::join(roster, ", "),
                                             did_you_mean(fault.component, roster)));
  }
  fault.kind = kind_of<ProcessFault::Kind>(entry, kProcessKinds);
  if (fault.kind == ProcessFault::Kind::kSlow) {
    read_times(entry, fault);
    fault.step_ms = entry.number("step_ms", {0.01, 10000});
  } else {
    fault.from_ns = nanoseconds(entry.number("at_s", {0, kLongest_s}));
    if (fault.kind == ProcessFault::Kind::kStop) fault.for_s = entry.number("for_s", {0.01, 3600});
  }
  return fault;
}

std::string device_of(Configuration& entry, const FaultTargets& targets) {
  std::string name = entry.text("device", breakable_devices());
  const auto& beside = targets.beside;
  if (beside && std::find(beside->begin(), beside->end(), name) == beside->end()) {
    throw entry.error("device", fmt::format("found {}, which does not run beside this run, accepted {}", name,
                                            beside->empty() ? "none: the manifest has no emulated devices"
                                                            : fmt::format("{}", fmt::join(*beside, ", "))));
  }
  return name;
}

DeviceFault read_device_fault(Configuration& entry, const FaultTargets& targets) {
  DeviceFault fault;
  const auto commands = commands_of(device_of(entry, targets));
  std::vector<std::string> names;
  for (const DeviceCommand* command : commands) names.emplace_back(command->name);
  const std::string kind = entry.text("kind", names);
  fault.order.command = *std::find_if(commands.begin(), commands.end(), [&](const auto* c) { return c->name == kind; });
  const DeviceCommand& command = *fault.order.command;
  const std::size_t most = command.of == "joint" ? targets.joints : command.of == "module" ? targets.modules : kPorts;
  if (!command.of.empty())
    fault.order.index =
        static_cast<std::size_t>(entry.integer(std::string(command.of), 0, static_cast<std::int64_t>(most) - 1));
  const std::string value(command.value);
  if (command.whole)
    fault.order.value = static_cast<double>(entry.integer(value, std::llround(command.min), std::llround(command.max)));
  else if (!value.empty()) fault.order.value = entry.number(value, {command.min, command.max});
  read_times(entry, fault);
  if (command.end.empty() && entry.has("until_s"))
    throw entry.error("until_s", fmt::format("found a time, accepted none: nothing ends {}", kind));
  return fault;
}

}  // namespace

FaultPlan load_fault_plan(const std::filesystem::path& file, const FaultTargets& targets) {
  FaultPlan plan;
  if (file.empty()) return plan;
  Configuration root = Configuration::load(file);
  plan.seed = static_cast<std::uint64_t>(root.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), 1));
  std::uint64_t number = 0;
  for (Configuration& entry : root.list("faults")) {
    ++number;
    if (int{entry.has("topic")} + int{entry.has("link")} + int{entry.has("process")} + int{entry.has("device")} != 1)
      throw entry.error("topic", "found none or several of topic, link, process and device, accepted one of them");
    if (entry.has("topic")) {
      plan.topics.push_back(read_topic_fault(entry));
      plan.topics.back().number = number;
    } else if (entry.has("link")) {
      plan.links.push_back(read_link_fault(entry, targets.roster));
      for (TopicFault& fault : topics_across(plan.links.back(), targets.roster)) {
        fault.number = number;
        plan.topics.push_back(std::move(fault));
      }
    } else if (entry.has("device")) {
      plan.devices.push_back(read_device_fault(entry, targets));
    } else {
      plan.processes.push_back(read_process_fault(entry, targets.roster));
    }
    entry.finish();
  }
  root.finish();
  return plan;
}

std::string describe(const TopicFault& fault) {
  return fmt::format("{} of {}", kTopicKinds[static_cast<std::size_t>(fault.kind)], fault.topic->name);
}

std::string describe(const LinkFault& fault) {
  return fmt::format("link down between {} and the others", fmt::join(fault.components, ", "));
}

std::string describe(const ProcessFault& fault) {
  return fmt::format("{} of {}", kProcessKinds[static_cast<std::size_t>(fault.kind)], fault.component);
}

std::string describe(const DeviceFault& fault) {
  return fmt::format("{} of {}", line_of(fault.order), fault.order.command->device);
}

}  // namespace constrictor
