#include "cli/run_observer.hpp"

#include <fmt/format.h>

#include <array>

#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

namespace wire = dds::barrier_topics;

template <std::size_t N>
const char* name_in(const std::array<const char*, N>& names, std::uint8_t index) {
  return index < N ? names[index] : "?";
}

}  // namespace

struct RunObserver::Readers {
  explicit Readers(std::uint32_t number)
      : domain(number),
        // Statuses are few and the sum of their counts goes into the report: none may be lost.
        status(dds::Reader<msg::ComponentStatus>::member(domain.participant(), wire::kStatus)),
        waiting(dds::Reader<msg::Waiting>::member(domain.participant(), wire::kWaiting)),
        tick(dds::Reader<msg::Tick>::observer(domain.participant(), wire::kTick)),
        mission(dds::Reader<msg::MissionStatus>::observer(domain.participant(), std::string(topics::kMissionStatus.name))),
        task(dds::Reader<msg::TaskStatus>::observer(domain.participant(), std::string(topics::kTaskStatus.name))),
        authority(dds::Reader<msg::Authority>::observer(domain.participant(), std::string(topics::kAuthority.name))),
        run_state(dds::Reader<msg::RunState>::observer(domain.participant(), wire::kRunState)) {}
  dds::Domain domain;
  dds::Reader<msg::ComponentStatus> status;
  dds::Reader<msg::Waiting> waiting;
  dds::Reader<msg::Tick> tick;  ///< only until the period is known: ticks are many
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::Authority> authority;
  dds::Reader<msg::RunState> run_state;
};

bool RunView::ended(const std::string& component) const {
  const auto found = components.find(component);
  return found != components.end() && found->second.state == msg::kComponentEnded;
}

RunObserver::RunObserver(std::uint32_t domain) : readers_(std::make_unique<Readers>(domain)) {}
RunObserver::~RunObserver() = default;

std::vector<std::string> RunObserver::poll() {
  if (readers_->tick.get() > 0) {
    bool known = false;
    readers_->tick.take([&](const msg::Tick& tick) {
      view_.period_s = static_cast<double>(tick.period_ns) * 1e-9;
      view_.tick = std::max(view_.tick, tick.index);
      known = true;
    });
    if (known) readers_->tick = {};
  }
  readers_->status.take([&](const msg::ComponentStatus& status) {
    const std::string name = status.component;
    const auto before = view_.components.find(name);
    if (before != view_.components.end()) {
      if (status.incarnation < before->second.incarnation) return;
      if (status.incarnation > before->second.incarnation) {
        earlier_overruns_[name] += before->second.overruns;
        earlier_refused_[name] += before->second.refused;
      }
      // A reset begins again at tick 0.
      if (status.epoch > before->second.epoch) view_.tick = -1;
    }
    view_.components[name] = status;
    view_.overruns[name] = earlier_overruns_[name] + status.overruns;
    view_.refused[name] = earlier_refused_[name] + status.refused;
    view_.tick = std::max(view_.tick, status.tick);
  });
  readers_->mission.take([&](const msg::MissionStatus& mission) {
    view_.mission = mission;
    view_.tick = std::max(view_.tick, mission.header.tick);
  });
  readers_->task.take([&](const msg::TaskStatus& task) { view_.task = task; });
  readers_->authority.take([&](const msg::Authority& authority) { view_.authority = authority; });
  readers_->run_state.take([&](const msg::RunState& state) { view_.run_state = state; });
  std::vector<std::string> waiting;
  std::vector<std::string> waiting_for_tick;
  readers_->waiting.take([&](const msg::Waiting& message) {
    const auto told = told_waiting_.emplace(std::string(message.component) + message.topic + message.writer, -1).first;
    if (told->second == message.tick + 1) return;
    told->second = message.tick + 1;
    auto& list = std::string_view(message.topic) == "Tick" ? waiting_for_tick : waiting;
    list.push_back(fmt::format("{} waits for {} of {} at tick {}, for {:.0f} s so far", message.component, message.topic,
                                  message.writer, message.tick, message.waited_s));
  });
  if (!waiting.empty()) told_cause_ = std::chrono::steady_clock::now();
  // Everybody waits for the tick that the plant holds back for somebody: only the cause is worth telling, if there is one.
  const bool cause_known = std::chrono::steady_clock::now() - told_cause_ < std::chrono::seconds(5);
  if (!cause_known && !waiting_for_tick.empty()) waiting.push_back(waiting_for_tick.front());
  return waiting;
}

std::string progress_line(const RunView& view, double real_time_factor) {
  std::string line;
  if (view.tick < 0) return "starting";
  if (view.mission) {
    line += fmt::format("{} | ", *view.mission->state ? view.mission->state : "no mission state");
  }
  if (view.task && view.task->task != msg::kTaskNone) {
    line += task_name(view.task->task);
    if (*view.task->phase) line += fmt::format(" ({})", view.task->phase);
    line += " | ";
  }
  if (view.mission && view.mission->object_count > 0) {
    line += fmt::format("{} of {} objects done", view.mission->object_index, view.mission->object_count);
    if (view.mission->object_index < view.mission->object_count) line += fmt::format(", {} next", colour_name(view.mission->colour));
    line += " | ";
  }
  return line + fmt::format("{:.1f} s simulated, {:.1f}x real time", view.sim_time_s(), real_time_factor);
}

const char* task_name(std::uint8_t task) {
  static constexpr std::array<const char*, msg::kTaskCount> kNames = {
      "no task", "follow line", "search object", "track object", "pregrasp", "grasp", "drop", "rotate", "explore", "follow path"};
  return name_in(kNames, task);
}

const char* colour_name(std::uint8_t colour) {
  static constexpr std::array<const char*, msg::kColourCount> kNames = {"unknown", "green", "red", "blue", "yellow"};
  return name_in(kNames, colour);
}

const char* component_state_name(std::uint8_t state) {
  static constexpr std::array<const char*, 4> kNames = {"starting", "running", "waiting", "ended"};
  return name_in(kNames, state);
}

}  // namespace constrictor::cli
