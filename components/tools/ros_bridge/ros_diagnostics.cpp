#include "ros_bridge/ros_diagnostics.hpp"

#include <fmt/format.h>

#include <cmath>

#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"
#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {
namespace {

// Source: diagnostic_msgs/msg/DiagnosticStatus.msg.
constexpr std::uint8_t kOk = 0, kWarn = 1, kError = 2, kStale = 3;

std::string microseconds(double value_us) { return std::isnan(value_us) ? "unknown" : fmt::format("{:.0f}", value_us); }

}  // namespace

void Health::take(const msg::Tick& tick) {
  if (tick.epoch != epoch_) components_.clear();  // a reset: the members begin anew
  epoch_ = tick.epoch;
  tick_ = tick.index;
  time_ns_ = tick.time_ns;
}

void Health::take(const msg::RunState& state) { run_ = state; }

void Health::take(const msg::ComponentStatus& status) {
  const std::string name = printable(text_of(status.component));
  if (validate(status) || (components_.size() >= msg::kMaxMembers && !components_.contains(name))) return;
  Component& component = components_[name];
  const msg::ComponentStatus& before = component.newest;
  const bool older =
      status.epoch < before.epoch || (status.epoch == before.epoch && status.incarnation < before.incarnation);
  if (older && status.run_id == before.run_id) return;
  component.newest = status;
}

char* Health::keep(std::string words) { return text(texts_.emplace_back(std::move(words))); }

void Health::add(std::uint8_t level, std::string name, std::string message,
                 const std::vector<std::pair<const char*, std::string>>& values) {
  auto& list = values_.emplace_back();
  for (const auto& [key, value] : values) list.push_back({text(key), keep(value)});
  Status status{};
  status.level = level;
  status.name = keep(std::move(name));
  status.message = keep(std::move(message));
  status.hardware_id = text(robot_);
  borrow(status.values, list);
  statuses_.push_back(status);
}

void Health::add_component(const std::string& name, Component& component) {
  const msg::ComponentStatus& status = component.newest;
  const std::int64_t behind = tick_ - status.tick;
  std::uint8_t level = kOk;
  std::string message = "running";
  const std::string refusal = printable(text_of(status.last_refusal));
  if (status.state == msg::kComponentEnded) {
    level = kError;
    message = "ended while the run goes on";
  } else if (status.epoch == epoch_ && behind > kStale_ticks) {
    level = kStale;
    message = fmt::format("{} ticks behind the run", behind);
  } else if (status.state == msg::kComponentStarting || status.state == msg::kComponentWaiting) {
    level = kWarn;
    message = status.state == msg::kComponentStarting ? "starting" : "waits for another component";
  } else if (status.refused_count > component.reported_refused) {
    level = kWarn;
    message = "rejected messages: " + refusal;
  } else if (status.overruns > component.reported_overruns) {
    level = kWarn;
    message =
        fmt::format("{} steps were left out because it was too slow", status.overruns - component.reported_overruns);
  }
  component.reported_refused = status.refused_count;
  component.reported_overruns = status.overruns;
  add(level, "constrictor: " + name, message,
      {{"state", name_of(constants::kComponent, status.state)},
       {"tick", std::to_string(status.tick)},
       {"step time, median [us]", microseconds(status.step_time_p50_us)},
       {"step time, 99th percentile [us]", microseconds(status.step_time_p99_us)},
       {"CPU time [s]", fmt::format("{:.1f}", status.cpu_s)},
       {"steps left out", std::to_string(status.overruns)},
       {"jitter, 99th percentile [us]", microseconds(status.jitter_p99_us)},
       {"jitter, largest [us]", microseconds(status.jitter_max_us)},
       {"scheduling", printable(text_of(status.scheduling))},
       {"device", printable(text_of(status.device))},
       {"rejected messages", std::to_string(status.refused_count)},
       {"last rejection", refusal},
       {"incarnation", std::to_string(status.incarnation)},
       {"host", printable(text_of(status.host))},
       {"process", std::to_string(status.pid)}});
}

DiagnosticArray Health::report(const BridgeCounts& counts) {
  texts_.clear();
  values_.clear();
  statuses_.clear();
  for (auto& [name, component] : components_) add_component(name, component);
  if (run_) {
    add(kOk, "constrictor: run", run_->paused ? "paused" : "running",
        {{"tick", std::to_string(tick_)},
         {"epoch", std::to_string(run_->epoch)},
         {"seed", std::to_string(run_->seed)},
         {"speed, times real time",
          std::isnan(run_->real_time_factor) ? "unknown" : fmt::format("{:.2f}", run_->real_time_factor)}});
  }
  const bool trouble = counts.dropped > reported_dropped_ || counts.refused > reported_refused_;
  reported_dropped_ = counts.dropped;
  reported_refused_ = counts.refused;
  add(trouble ? kWarn : kOk, "constrictor: ros_bridge", trouble ? counts.last_reason : "running",
      {{"dropped messages of the run", std::to_string(counts.dropped)},
       {"refused requests", std::to_string(counts.refused)},
       {"requests without an answer", std::to_string(counts.unanswered)},
       {"last drop or refusal", counts.last_reason}});
  DiagnosticArray message{};
  message.header = header_of(sayable(time_ns_) ? time_ns_ : 0, text(""));
  borrow(message.status, statuses_);
  return message;
}

}  // namespace constrictor::ros_bridge
