#include "cli/teleop_view.hpp"

#include <fmt/format.h>

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
        events(dds::Reader<msg::TaskEvent>::member(participant, name(topics::kTaskEvent))) {}
  dds::Reader<msg::RunState> run;
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::JointState> joints;
  dds::Reader<msg::ContactState> contacts;
  dds::Reader<msg::TaskEvent> events;  ///< few, and each matters
};

TeleopObserver::TeleopObserver(std::int32_t participant) : readers_(std::make_unique<Readers>(participant)) {}
TeleopObserver::~TeleopObserver() = default;

void TeleopObserver::poll() {
  readers_->run.take([this](const msg::RunState& m) { view_.run = m; });
  readers_->task.take([this](const msg::TaskStatus& m) { view_.task = m; });
  readers_->mission.take([this](const msg::MissionStatus& m) { view_.mission = m; });
  readers_->joints.take([this](const msg::JointState& m) { view_.joints = m; });
  readers_->contacts.take([this](const msg::ContactState& m) { view_.contacts = m; });
  readers_->events.take([this](const msg::TaskEvent& m) {
    const char* what = m.event != msg::kEventNone ? event_name(m.event) : goal_state_name(m.goal_state);
    view_.events.push_back(fmt::format("{:8.2f} s  {}: {} {}", static_cast<double>(m.header.time_ns) * 1e-9, task_word(m.task), what, m.detail));
    if (view_.events.size() > kEvents) view_.events.pop_front();
  });
}

}  // namespace constrictor::cli
