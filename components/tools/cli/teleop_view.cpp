#include "cli/teleop_view.hpp"

#include <fmt/format.h>

#include "client/task_names.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor::cli {
namespace {

constexpr std::size_t kEvents = 64;  // a large terminal shows them

template <class T>
std::string name(const Topic<T>& topic) {
  return std::string(topic.name);
}

}  // namespace

struct TeleopObserver::Readers {
  explicit Readers(dds_entity_t participant)
      : task(dds::Reader<msg::TaskStatus>::observer(participant, name(topics::kTaskStatus))),
        mission(dds::Reader<msg::MissionStatus>::observer(participant, name(topics::kMissionStatus))),
        joints(dds::Reader<msg::JointState>::observer(participant, name(topics::kJointState))),
        contacts(dds::Reader<msg::ContactState>::observer(participant, name(topics::kContactState))),
        events(dds::Reader<msg::TaskEvent>::member(participant, name(topics::kTaskEvent))) {}
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::JointState> joints;
  dds::Reader<msg::ContactState> contacts;
  dds::Reader<msg::TaskEvent> events;  ///< reliable: events are few, and none may be missing on the screen
};

TeleopObserver::TeleopObserver(std::int32_t participant, const RunMonitor& monitor)
    : readers_(std::make_unique<Readers>(participant)), monitor_(monitor) {}
TeleopObserver::~TeleopObserver() = default;

void TeleopObserver::poll() {
  view_.run = monitor_.state();
  view_.silent_s = monitor_.attachment().silent_s();
  const auto keep_newest = [this](const auto& reader, auto& newest) {
    reader.take([&](const auto& message) {
      if (monitor_.is_present(message.header)) newest = message;
    });
  };
  keep_newest(readers_->task, view_.task);
  keep_newest(readers_->mission, view_.mission);
  keep_newest(readers_->joints, view_.joints);
  keep_newest(readers_->contacts, view_.contacts);
  readers_->events.take([this](const msg::TaskEvent& event) {
    if (view_.run && !monitor_.is_present(event.header)) return;
    const std::string what =
        event.event != msg::kEventNone ? event_name(event.event) : goal_state_name(event.goal_state);
    view_.events.push_back(fmt::format("{:8.2f} s  {}: {} {}", static_cast<double>(event.header.time_ns) * 1e-9,
                                       task_word(event.task), what, event.detail));
    if (view_.events.size() > kEvents) view_.events.pop_front();
  });
}

}  // namespace constrictor::cli
