#include "cli/fault_director.hpp"

#include <fmt/format.h>

#include <csignal>

namespace constrictor::cli {
namespace {

double seconds(std::int64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

}  // namespace

FaultDirector::FaultDirector(const FaultPlan& plan) {
  for (const auto& fault : plan.topics) {
    if (fault.kind != TopicFault::Kind::kLinkDown)  // the link's fault announces all of its topics
      announced_.push_back({describe(fault), seconds(fault.from_ns), seconds(fault.until_ns)});
  }
  for (const auto& fault : plan.links)
    announced_.push_back({describe(fault), seconds(fault.from_ns), seconds(fault.until_ns)});
  for (const auto& fault : plan.processes) {
    if (fault.kind == ProcessFault::Kind::kSlow)
      announced_.push_back({describe(fault), seconds(fault.from_ns), seconds(fault.until_ns)});
    else processes_.push_back({fault});
  }
  for (const auto& fault : plan.devices) {
    announced_.push_back(
        {describe(fault), seconds(fault.from_ns), seconds(fault.until_ns), fault.order.command->end.empty()});
    devices_.push_back({fault});
  }
}

void FaultDirector::continue_at(double sim_time_s) {
  for (auto& process : processes_)
    process.begun = process.over = process.begun || sim_time_s >= seconds(process.fault.from_ns);
  for (auto& [fault, sent] : devices_) {
    const bool momentary = fault.order.command->end.empty();
    if (sim_time_s >= seconds(momentary ? fault.from_ns : fault.until_ns)) sent = 2;
  }
  for (auto& announced : announced_) {
    if (sim_time_s >= (announced.momentary ? announced.from_s : announced.until_s)) announced.said = 2;
  }
}

std::vector<FaultDirector::Command> FaultDirector::commands(double sim_time_s) {
  std::vector<Command> due;
  for (auto& [fault, sent] : devices_) {
    const std::string device(fault.order.command->device);
    if (sent == 0 && sim_time_s >= seconds(fault.from_ns)) {
      sent = 1;
      due.push_back({device, line_of(fault.order)});
    }
    if (sent == 1 && sim_time_s >= seconds(fault.until_ns)) {
      sent = 2;
      due.push_back({device, end_of(fault.order)});
    }
  }
  return due;
}

std::vector<FaultDirector::Signal> FaultDirector::due(double sim_time_s, Clock::time_point now) {
  std::vector<Signal> signals;
  for (auto& [fault, begun, over, end] : processes_) {
    const bool stops = fault.kind == ProcessFault::Kind::kStop;
    if (!begun && sim_time_s >= seconds(fault.from_ns)) {
      begun = true;
      over = !stops;
      end = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(fault.for_s));
      signals.push_back({fault.component, stops ? SIGSTOP : SIGKILL});
      announced_.push_back({describe(fault), seconds(fault.from_ns), 2e9});
    } else if (begun && !over && now >= end) {
      over = true;
      signals.push_back({fault.component, SIGCONT});
    }
  }
  return signals;
}

std::vector<std::string> FaultDirector::news(double sim_time_s) {
  std::vector<std::string> lines;
  for (auto& [text, from_s, until_s, momentary, said] : announced_) {
    if (said == 0 && sim_time_s >= from_s) {
      said = 1;
      lines.push_back(fmt::format("fault: {} begins at {:.1f} s", text, from_s));
    }
    if (said == 1 && sim_time_s >= until_s) {
      said = 2;
      lines.push_back(fmt::format("fault: {} ends at {:.1f} s", text, until_s));
    }
  }
  return lines;
}

}  // namespace constrictor::cli
