#include "cli/teleop_view.hpp"

#include <fmt/format.h>

#include <utility>

#include "cli/task_names.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

constexpr std::size_t kEvents = 3;

template <class T>
std::string name(const Topic<T>& topic) {
  return std::string(topic.name);
}

}  // namespace

struct TeleopObserver::Readers {
  explicit Readers(dds_entity_t participant)
      : run(dds::Reader<msg::RunState>::member(participant, dds::barrier_topics::kRunState)),
        task(dds::Reader<msg::TaskStatus>::observer(participant, name(topics::kTaskStatus))),
        mission(dds::Reader<msg::MissionStatus>::observer(participant, name(topics::kMissionStatus))),
        joints(dds::Reader<msg::JointState>::observer(participant, name(topics::kJointState))),
        contacts(dds::Reader<msg::ContactState>::observer(participant, name(topics::kContactState))),
        events(dds::Reader<msg::TaskEvent>::member(participant, name(topics::kTaskEvent))),
        statuses(dds::Reader<msg::ComponentStatus>::member(participant, dds::barrier_topics::kStatus)),
        input(dds::Reader<msg::Authority>::observer(participant, name(topics::kAuthority))) {}
  dds::Reader<msg::RunState> run;
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::JointState> joints;
  dds::Reader<msg::ContactState> contacts;
  dds::Reader<msg::TaskEvent> events;  ///< few, and each matters
  dds::Reader<msg::ComponentStatus> statuses;  ///< for the plant's last one
  dds::Reader<msg::Authority> input;           ///< only to see whether it is there
};

TeleopObserver::TeleopObserver(std::int32_t participant, std::string plant)
    : readers_(std::make_unique<Readers>(participant)), plant_(std::move(plant)) {}
TeleopObserver::~TeleopObserver() = default;

void TeleopObserver::poll() {
  readers_->run.take([this](const msg::RunState& m) {
    if (!run_id_) run_id_ = m.run_id;
    signs_.run_id = m.run_id;
    ++signs_.states_heard;
    if (m.run_id == *run_id_) view_.run = m;
  });
  // What comes before the first RunState cannot be told from what another run left: the next one is soon there.
  const auto ours = [this](const msg::Header& header) { return run_id_ && header.run_id == *run_id_ && view_.run && header.epoch >= view_.run->epoch; };
  readers_->task.take([&](const msg::TaskStatus& m) { if (ours(m.header)) view_.task = m; });
  readers_->mission.take([&](const msg::MissionStatus& m) { if (ours(m.header)) view_.mission = m; });
  readers_->joints.take([&](const msg::JointState& m) { if (ours(m.header)) view_.joints = m; });
  readers_->contacts.take([&](const msg::ContactState& m) { if (ours(m.header)) view_.contacts = m; });
  readers_->events.take([&](const msg::TaskEvent& m) {
    if (run_id_ && !ours(m.header)) return;
    const char* what = m.event != msg::kEventNone ? event_name(m.event) : goal_state_name(m.goal_state);
    view_.events.push_back(fmt::format("{:8.2f} s  {}: {} {}", static_cast<double>(m.header.time_ns) * 1e-9, task_word(m.task), what, m.detail));
    if (view_.events.size() > kEvents) view_.events.pop_front();
  });
  readers_->statuses.take([this](const msg::ComponentStatus& m) {
    if (run_id_ && m.run_id == *run_id_ && plant_ == m.component) signs_.plant_ended = m.state == msg::kComponentEnded;
  });
  readers_->input.take([](const msg::Authority&) {});
}

RunSigns TeleopObserver::signs() const {
  RunSigns signs = signs_;
  signs.input = readers_->input.writers() > 0;
  return signs;
}

}  // namespace constrictor::cli
