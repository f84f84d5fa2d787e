#include "dashboard/dashboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "constrictor/reflect.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;

constexpr auto kShowEvery = 50ms;  // of wall time, however fast the run is

std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
}

/// Topics that viewers must not see, because their samples contain the token of the run, or are of no use to them,
/// because they contain the checkpoints of members.
bool shown(const std::string& topic) {
  const std::string_view hidden[] = {barrier_topics::kRequest.name, barrier_topics::kRunControl.name,
                                     topics::kPlannerRequest.name, barrier_topics::kTickDone.name,
                                     barrier_topics::kResume.name};
  return std::find(std::begin(hidden), std::end(hidden), topic) == std::end(hidden);
}

Channel json_channel(const std::string& topic, const std::string& schema_name) {
  return {0, topic, "json", schema_name, R"({"type":"object","properties":{}})", "jsonschema"};
}

Channel image_channel(const std::string& topic) {
  return {0, topic, "cdr", "sensor_msgs/msg/Image", ros_image_schema(), "ros2msg"};
}

template <class T>
dds::Reader<T> newest_of(std::int32_t participant, const Topic<T>& topic) {
  return dds::Reader<T>::observer(participant, std::string(topic.name));
}

}  // namespace

struct Dashboard::Readers {
  explicit Readers(std::int32_t p)
      // Written once in an epoch: the sample that the writer keeps for late readers is needed.
      : scene(dds::Reader<msg::SceneDescription>::member(p, std::string(topics::kSceneDescription.name))),
        world(newest_of(p, topics::kWorldState)),
        joints(newest_of(p, topics::kJointState)),
        contacts(newest_of(p, topics::kContactState)),
        pose(newest_of(p, topics::kRobotPose)),
        map(newest_of(p, topics::kFieldMap)),
        mission(dds::Reader<msg::MissionStatus>::member(p, std::string(topics::kMissionStatus.name))),
        task(newest_of(p, topics::kTaskStatus)),
        authority(newest_of(p, topics::kAuthority)),
        stop(newest_of(p, topics::kStopState)),
        events(dds::Reader<msg::TaskEvent>::member(p, std::string(topics::kTaskEvent.name))),
        camera(newest_of(p, topics::kCameraImage)),
        processed(newest_of(p, topics::kProcessedImage)),
        statuses(dds::Reader<msg::ComponentStatus>::member(p, barrier_topics::kStatus.name)) {}

  dds::Reader<msg::SceneDescription> scene;
  dds::Reader<msg::WorldState> world;
  dds::Reader<msg::JointState> joints;
  dds::Reader<msg::ContactState> contacts;
  dds::Reader<msg::RobotPose> pose;
  dds::Reader<msg::FieldMap> map;
  dds::Reader<msg::MissionStatus> mission;
  dds::Reader<msg::TaskStatus> task;
  dds::Reader<msg::Authority> authority;
  dds::Reader<msg::StopState> stop;
  dds::Reader<msg::TaskEvent> events;
  dds::Reader<msg::CameraImage> camera, processed;
  dds::Reader<msg::ComponentStatus> statuses;
};

Dashboard::Dashboard(std::unique_ptr<Controls> controls, const std::string& name, WebOptions options)
    : controls_(std::move(controls)),
      server_(
          std::move(options), name, controls_->services(),
          [this](WebServer::Call call) { controls_->add(std::move(call)); },
          [this](WebServer::Change wish) { change(std::move(wish)); }),
      tap_(controls_->participant(), shown, false),
      readers_(std::make_unique<Readers>(controls_->participant())),
      lines_(controls_->participant()),
      parameters_(controls_->participant()),
      scene_(server_.add_channel(json_channel("view/scene", "foxglove.SceneUpdate"))),
      transforms_(server_.add_channel(json_channel("view/transforms", "foxglove.FrameTransforms"))),
      camera_(server_.add_channel(image_channel("view/camera"))),
      processed_(server_.add_channel(image_channel("view/processed"))),
      log_(server_.add_channel(json_channel("view/log", "foxglove.Log"))),
      state_(server_.add_channel(json_channel("view/state", "constrictor.PageState"))) {}

Dashboard::~Dashboard() = default;

void Dashboard::serve() {
  tap_.discover();
  tap_.wait(10ms);
  tap_.take([this](const dds::TopicTap::Topic& topic, const dds::RawSample& sample) { pass_on(topic, sample); });
  take_typed();
  take_parameters();
  controls_->poll();
  newest_.run = controls_->run();
  if (auto replay = controls_->replay(); replay != newest_.replay) {
    newest_.replay = std::move(replay);
    changed_ = true;
  }
  show();
  server_.poll();
}

void Dashboard::pass_on(const dds::TopicTap::Topic& topic, const dds::RawSample& sample) {
  if (topic.schema.name.empty()) return;  // no viewer could read it
  const auto [channel, added] = channels_.try_emplace(&topic);
  if (added) {
    channel->second = server_.add_channel({0, topic.name, "cdr", topic.schema.name, topic.schema.text, "ros2msg"});
  }
  server_.send(channel->second, static_cast<std::uint64_t>(sample.source_time_ns),
               {reinterpret_cast<const char*>(sample.bytes.data()), sample.bytes.size()});
}

void Dashboard::take_typed() {
  const auto keep = [&](const auto& reader, auto& to) {
    reader.take([&](const auto& message) {
      if (validate(message)) return;
      to = message;
      changed_ = true;
    });
  };
  keep(readers_->scene, newest_.scene);
  readers_->world.take([&](const msg::WorldState& world) {
    if (validate(world)) return;
    const auto& before = newest_.world;
    // After a reset nothing of the epoch before is shown any more.
    if (before && (before->header.run_id != world.header.run_id || before->header.epoch != world.header.epoch)) {
      newest_.start.reset();
      newest_.pose.reset();
      newest_.map.reset();
      newest_.events.clear();
    }
    // A replay may go back. What happened later than this has not happened yet.
    auto& events = newest_.events;
    while (before && world.header.tick < before->header.tick && !events.empty() &&
           events.back().header.tick > world.header.tick)
      events.pop_back();
    newest_.world = world;
    changed_ = true;
  });
  keep(readers_->joints, newest_.joints);
  keep(readers_->contacts, newest_.contacts);
  keep(readers_->pose, newest_.pose);
  keep(readers_->map, newest_.map);
  keep(readers_->mission, newest_.mission);
  keep(readers_->task, newest_.task);
  keep(readers_->authority, newest_.authority);
  keep(readers_->stop, newest_.stop);
  readers_->statuses.take([&](const msg::ComponentStatus& status) {
    const std::string component = text_of(status.component);
    const bool room = newest_.processes.size() < msg::kMaxMembers || newest_.processes.contains(component);
    if (!validate(status) && room) newest_.processes[component] = status;
  });
  readers_->events.take([&](const msg::TaskEvent& event) {
    if (validate(event)) return;
    auto& events = newest_.events;
    while (!events.empty() && events.back().header.sequence_number >= event.header.sequence_number)
      events.pop_back();  // a replay has gone back, or a new epoch has begun
    events.push_back(event);
    if (newest_.events.size() > Newest::kMostEvents) newest_.events.pop_front();
    const std::uint64_t time_ns = now_ns();
    server_.send(log_, time_ns, log_of(event, time_ns).dump());
  });
  lines_.take([&](const msg::LogLine& line, std::uint64_t) { server_.send(log_, now_ns(), log_of(line).dump()); });
  align(newest_);
  const auto image = [&](const dds::Reader<msg::CameraImage>& reader, std::uint32_t channel) {
    const bool wanted = server_.wanted(channel);
    reader.take([&](const msg::CameraImage& message) {
      if (!wanted) return;
      const std::uint64_t time_ns = now_ns();
      if (const auto cdr = ros_image(message, "head", time_ns)) server_.send(channel, time_ns, *cdr);
    });
  };
  image(readers_->camera, camera_);
  image(readers_->processed, processed_);
}

void Dashboard::take_parameters() {
  if (!parameters_.poll()) return;
  std::vector<ParameterValue> values;
  for (const auto& [name, owned] : parameters_.parameters()) {
    const msg::Parameter& parameter = owned.parameter;
    const double value = coming_value(parameter);  // as on the page
    if (!std::isfinite(value)) continue;           // of a stranger: the components accept no such value
    const nlohmann::json shown = value_json(parameter, value);
    values.push_back({name, shown, shown.is_number() && !parameter.is_integer});
  }
  server_.set_parameters(values);
}

/// Passes on what is a value of a known parameter, as `constrictor param set` does. `input` decides about the rest.
void Dashboard::change(WebServer::Change wish) {
  using Result = WebServer::Change::Result;
  const auto known = parameters_.parameters();
  std::vector<Result> results(wish.values.size());
  WebServer::Change good;
  std::vector<std::size_t> places;  // of the good ones
  for (std::size_t i = 0; i < wish.values.size(); ++i) {
    const auto& [name, value, real] = wish.values[i];
    const auto owned = known.find(name);
    if (owned == known.end()) {
      results[i].refusal = "there is no such parameter";
    } else if (const std::string frozen = controls_->frozen(); !frozen.empty()) {
      results[i].refusal = frozen;
    } else if (const auto number = value_from_json(owned->second.parameter, value)) {
      good.values.push_back({name, *number});
      places.push_back(i);
    } else {
      results[i].refusal =
          fmt::format("found {:.40}, accepted {}", value.dump(), accepted_text(owned->second.parameter));
    }
  }
  if (places.empty()) return wish.done(results);
  good.done = [known, places, results, done = wish.done, names = good.values](const std::vector<Result>& answers) {
    auto all = results;
    for (std::size_t i = 0; i < places.size(); ++i) {
      all[places[i]] = answers[i];
      if (answers[i].refusal.empty())
        all[places[i]].value = value_json(known.at(names[i].name).parameter, answers[i].value.get<double>());
    }
    done(all);
  };
  controls_->change(std::move(good));
}

void Dashboard::show() {
  const auto now = std::chrono::steady_clock::now();
  // A viewer that comes while the run is paused must see it, too.
  if (now - shown_ < (changed_ ? kShowEvery : 500ms)) return;
  shown_ = now;
  changed_ = false;
  const std::uint64_t time_ns = now_ns();
  const auto send = [&](std::uint32_t channel, auto&& make) {
    if (server_.wanted(channel))
      server_.send(channel, time_ns, make().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  };
  send(scene_, [&] { return scene_update(newest_, time_ns); });
  send(transforms_, [&] { return frame_transforms(newest_, time_ns); });
  send(state_, [&] { return page_state(newest_); });
}

}  // namespace constrictor::dashboard
