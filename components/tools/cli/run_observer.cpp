#include "cli/run_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "constrictor/constants.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/acknowledgements.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/mailbox.hpp"
#include "runtime/wire.hpp"

namespace constrictor::cli {
namespace {

namespace wire = barrier_topics;
constexpr auto kSettle = std::chrono::milliseconds(500);  // until the first messages of all topics have arrived
constexpr std::int64_t kMostAhead =
    50;  // in any configuration, a component is at most this many ticks ahead of another one

}  // namespace

struct RunObserver::Readers {
  explicit Readers(std::uint32_t number)
      : domain(
            (dds::Mailbox::open_for_this_process(), dds::create_domain(number, dds::Reach::kLoopback, dds::kNoLinger))),
        participant(dds::create_participant(number, dds::Reach::kLoopback, {})),
        // Reliable, because the report contains them, or sums of them.
        hello(dds::Reader<msg::Hello>::member(participant.get(), wire::kHello)),
        status(dds::Reader<msg::ComponentStatus>::member(participant.get(), wire::kStatus)),
        waiting(dds::Reader<msg::Waiting>::member(participant.get(), wire::kWaiting)),
        tick(dds::Reader<msg::Tick>::observer(participant.get(), wire::kTick)),
        mission(dds::Reader<msg::MissionStatus>::observer(participant.get(), std::string(topics::kMissionStatus.name))),
        task(dds::Reader<msg::TaskStatus>::observer(participant.get(), std::string(topics::kTaskStatus.name))),
        authority(dds::Reader<msg::Authority>::observer(participant.get(), std::string(topics::kAuthority.name))),
        run_state(dds::Reader<msg::RunState>::observer(participant.get(), wire::kRunState)) {}
  dds::Entity domain;
  dds::Entity participant;
  dds::Reader<msg::Hello> hello;
  dds::Reader<msg::ComponentStatus> status;
  dds::Reader<msg::Waiting> waiting;
  dds::Reader<msg::Tick> tick;  ///< closed once the period is known, because ticks are many
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::Authority> authority;
  dds::Reader<msg::RunState> run_state;
};

bool RunView::ended(const std::string& component) const {
  const auto found = components.find(component);
  return found != components.end() && found->second.state == msg::kComponentEnded;
}

bool RunView::run_is_over() const {
  return present_.run_id() != 0 && std::any_of(components.begin(), components.end(), [this](const auto& named) {
           const msg::ComponentStatus& status = named.second;
           return status.state == msg::kComponentEnded && status.run_id == present_.run_id() &&
                  status.epoch == present_.epoch();
         });
}

bool RunView::over(const msg::Waiting& waiting) const {
  const auto waiter = components.find(waiting.component);
  // `waiting` has no run id: the waiter waits for the begin of the run. Its first status with a run id ends the wait.
  if (waiting.run_id == 0) return waiter != components.end() && waiter->second.run_id != 0;
  if (present_.run_id() == 0) return false;
  const bool done =
      waiter != components.end() && waiter->second.epoch == present_.epoch() && waiter->second.tick >= waiting.tick;
  const bool of_earlier_epoch = tick >= 0 && waiting.tick > tick + kMostAhead;
  return waiting.run_id != present_.run_id() || done || of_earlier_epoch || tick > waiting.tick + kMostAhead;
}

bool RunView::present(std::uint64_t message_run_id, std::uint32_t message_epoch) {
  const auto is = present_.take(message_run_id, message_epoch);
  if (is == NewestEpoch::Is::kNew) {
    tick = -1;
    mission.reset();
    task.reset();
    authority.reset();
  }
  return is != NewestEpoch::Is::kOther;
}

void RunView::take(const msg::Tick& message) {
  if (!present(message.run_id, message.epoch)) return;
  period_s = static_cast<double>(message.period_ns) * 1e-9;
  tick = std::max(tick, message.index);
}

void RunView::take(const msg::ComponentStatus& message) {
  if (meant_ != 0 && message.run_id != 0 && message.run_id != meant_) return;
  const std::string name = message.component;
  const auto before = components.find(name);
  if (before != components.end()) {
    // A new incarnation is in no epoch until it is resumed.
    const bool anew = message.incarnation > before->second.incarnation;
    if (message.incarnation < before->second.incarnation || (!anew && message.epoch < before->second.epoch)) return;
    if (anew) {
      earlier_overruns_[name] += before->second.overruns;
      earlier_refused_[name] += before->second.refused_count;
    }
  }
  components[name] = message;
  overruns[name] = earlier_overruns_[name] + message.overruns;
  refused[name] = earlier_refused_[name] + message.refused_count;
  if (present(message.run_id, message.epoch)) tick = std::max(tick, message.tick);
}

void RunView::take(const msg::Hello& message) {
  if (message.run_id != 0 && meant_ != 0 && message.run_id != meant_) return;
  msg::Hello& newest = hellos[message.component];
  if (message.incarnation >= newest.incarnation) newest = message;
}

void RunView::take(const msg::MissionStatus& message) {
  if (!present(message.header.run_id, message.header.epoch)) return;
  mission = message;
  tick = std::max(tick, message.header.tick);
}

void RunView::take(const msg::TaskStatus& message) {
  if (present(message.header.run_id, message.header.epoch)) task = message;
}

void RunView::take(const msg::Authority& message) {
  if (present(message.header.run_id, message.header.epoch)) authority = message;
}

void RunView::take(const msg::RunState& message) {
  if (!present(message.run_id, message.epoch)) return;
  run_state = message;
  tick = std::max(tick, message.tick - 1);  // RunState.tick is the next one
}

bool RunView::mission_done() const { return mission && mission->outcome != msg::kMissionRunning; }

RunObserver::RunObserver(std::uint32_t domain, std::uint64_t run_id)
    : readers_(std::make_unique<Readers>(domain)), view_(run_id) {}
RunObserver::~RunObserver() = default;

std::int32_t RunObserver::participant() const { return readers_->participant.get(); }

std::vector<std::string> RunObserver::poll() {
  const auto into_view = [this](const auto& message) { view_.take(message); };
  if (readers_->tick.get() > 0) {
    bool known = false;
    readers_->tick.take([&](const msg::Tick& tick) {
      view_.take(tick);
      known = true;
    });
    if (known) readers_->tick = {};
  }
  readers_->hello.take(into_view);
  readers_->run_state.take(into_view);
  readers_->status.take(into_view);
  readers_->mission.take(into_view);
  readers_->task.take(into_view);
  readers_->authority.take(into_view);
  std::vector<std::string> waiting;
  std::vector<std::string> waiting_for_tick;
  readers_->waiting.take([&](const msg::Waiting& message) { waits_.push_back(message); });
  // Writers keep messages about waits for late observers. Only the state of the run shows whether a wait has ended.
  if (std::chrono::steady_clock::now() - begun_ < kSettle) return {};
  for (const auto& message : std::exchange(waits_, {})) {
    if (view_.over(message)) continue;
    const auto reported =
        reported_waits_.emplace(std::string(message.component) + message.topic + message.writer, -1).first;
    if (reported->second == message.tick + 1) continue;
    reported->second = message.tick + 1;
    if (view_.mission_done() && std::string_view(message.writer) == "report") {
      waiting.emplace_back("the mission is done; report draws its figure");
      continue;
    }
    auto& list = std::string_view(message.topic) == "Tick" ? waiting_for_tick : waiting;
    list.push_back(fmt::format("{} waits for {} of {} at tick {}, for {:.0f} s so far", message.component,
                               message.topic, message.writer, message.tick, message.waited_s));
  }
  if (!waiting.empty()) cause_reported_ = std::chrono::steady_clock::now();
  // While the plant waits for one member, all other members wait for the next tick. Only the cause is reported.
  const bool cause_known = std::chrono::steady_clock::now() - cause_reported_ < std::chrono::seconds(5);
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
    line += words_of(constants::kTask, view.task->task);
    if (*view.task->phase) line += fmt::format(" ({})", view.task->phase);
    line += " | ";
  }
  if (view.mission && view.mission->object_count > 0) {
    line += fmt::format("{} of {} objects delivered", view.mission->delivered_count, view.mission->object_count);
    if (view.mission->object_index < view.mission->object_count)
      line += fmt::format(", {} next", words_of(constants::kColour, view.mission->colour));
    line += " | ";
  }
  line += fmt::format("{:.1f} s simulated", view.sim_time_s());
  // A run that stands still, for example at its end, has no speed.
  return real_time_factor > 0.0 ? line + fmt::format(", {:.1f}x real time", real_time_factor) : line;
}

}  // namespace constrictor::cli
