#include "dashboard/dashboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "constrictor/reflect.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "dashboard/commands.hpp"
#include "views/camera_views.hpp"
#include "views/view_topics.hpp"
#include "views/views.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;
using views::View;

constexpr auto kShowEvery = 50ms;  // of wall time, however fast the run is
constexpr auto kFarewell = 300ms;  // until the last words have reached the viewers

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

Channel channel_of(views::View view) {
  const auto& [topic, encoding, schema_name, schema_encoding, schema] =
      views::kViewTopics[static_cast<std::size_t>(view)];
  return {0, topic, encoding, schema_name, schema, schema_encoding};
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
        // Written once in an epoch, as the scene.
        lens(dds::Reader<msg::CameraInfo>::member(p, std::string(topics::kCameraInfo.name))),
        line(newest_of(p, topics::kLinePercept)),
        blobs(newest_of(p, topics::kObjectPercepts)),
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
  dds::Reader<msg::CameraInfo> lens;
  dds::Reader<msg::LinePercept> line;
  dds::Reader<msg::ObjectPercepts> blobs;
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
          std::move(options), name, controls_->services(), [this](WebServer::Call wish) { call(std::move(wish)); },
          [this](WebServer::Change wish) { change(std::move(wish)); }),
      tap_(controls_->participant(), shown, false),
      readers_(std::make_unique<Readers>(controls_->participant())),
      lines_(controls_->participant()),
      parameters_(controls_->participant()),
      scene_(server_.add_channel(channel_of(View::kScene))),
      transforms_(server_.add_channel(channel_of(View::kTransforms))),
      camera_(server_.add_channel(channel_of(View::kCamera))),
      processed_(server_.add_channel(channel_of(View::kProcessed))),
      annotations_(server_.add_channel(channel_of(View::kAnnotations))),
      lens_(server_.add_channel(channel_of(View::kCalibration))),
      log_(server_.add_channel(channel_of(View::kLog))),
      state_(server_.add_channel({0, "view/state", "json", "constrictor.PageState", views::kAnyObject, "jsonschema"})) {
}

Dashboard::~Dashboard() = default;

void Dashboard::serve() {
  tap_.discover();
  pass_news();
}

void Dashboard::pass_news() {
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
  const auto take = [&](const auto& reader, auto& to) {
    reader.take([&](const auto& message) { changed_ |= views::keep(to, message); });
  };
  take(readers_->scene, newest_.scene);
  readers_->world.take([&](const msg::WorldState& world) { changed_ |= views::keep_world(newest_, world); });
  take(readers_->joints, newest_.joints);
  take(readers_->contacts, newest_.contacts);
  take(readers_->lens, newest_.camera);
  take(readers_->pose, newest_.pose);
  take(readers_->map, newest_.map);
  take(readers_->mission, newest_.mission);
  take(readers_->task, newest_.task);
  take(readers_->authority, newest_.authority);
  take(readers_->stop, newest_.stop);
  readers_->statuses.take([&](const msg::ComponentStatus& status) {
    const std::string component = text_of(status.component);
    const bool room = newest_.processes.size() < msg::kMaxMembers || newest_.processes.contains(component);
    if (!validate(status) && room) newest_.processes[component] = status;
  });
  readers_->events.take([&](const msg::TaskEvent& event) {
    const std::uint64_t time_ns = now_ns();
    if (views::keep_event(newest_, event)) server_.send(log_, time_ns, views::log_of(event, time_ns).dump());
  });
  lines_.take(
      [&](const msg::LogLine& line, std::uint64_t) { server_.send(log_, now_ns(), views::log_of(line).dump()); });
  views::align(newest_);
  take_images();
}

void Dashboard::take_images() {
  const auto image = [&](const dds::Reader<msg::CameraImage>& reader, std::uint32_t channel) {
    const bool wanted = server_.wanted(channel);
    reader.take([&](const msg::CameraImage& message) {
      if (!wanted) return;
      const std::uint64_t time_ns = now_ns();
      if (const auto cdr = views::ros_image(message, views::kCameraFrame, time_ns))
        server_.send(channel, time_ns, *cdr);
    });
  };
  image(readers_->camera, camera_);
  image(readers_->processed, processed_);
  readers_->line.take([&](const msg::LinePercept& line) { views::keep(newest_.line, line); });
  // Perception writes the line before the objects of the same image.
  readers_->blobs.take([&](const msg::ObjectPercepts& blobs) {
    if (!views::keep(newest_.blobs, blobs) || !server_.wanted(annotations_)) return;
    const std::uint64_t time_ns = now_ns();
    server_.send(annotations_, time_ns, views::image_annotations(newest_, time_ns).dump());
  });
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

/// Answers at once what this process knows already, and passes on the rest.
void Dashboard::call(WebServer::Call call) {
  take_parameters();
  // Until the lists are known, the call waits for them in a thread of its own.
  if (call.service == kParameterList && parameters_.up_to_date())
    call.answer(parameters_text(parameters_.parameters()));
  else controls_->add(std::move(call));
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
      results[i].refusal = "there is no such parameter" + did_you_mean(name, known);
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

void Dashboard::say_farewell() {
  server_.tell_end(over());
  for (const auto end = std::chrono::steady_clock::now() + kFarewell; std::chrono::steady_clock::now() < end;)
    pass_news();  // new topics would be those of another run in this domain
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
  send(scene_, [&] { return views::scene_update(newest_, time_ns); });
  send(transforms_, [&] { return views::frame_transforms(newest_, time_ns); });
  if (newest_.camera) send(lens_, [&] { return views::camera_calibration(*newest_.camera, time_ns); });
  send(state_, [&] { return views::page_state(newest_); });
}

}  // namespace constrictor::dashboard
