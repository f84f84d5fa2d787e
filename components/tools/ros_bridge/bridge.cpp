#include "ros_bridge/bridge.hpp"

#include <utility>

#include "cyclone/create_domain.hpp"
#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {

using namespace std::chrono_literals;

namespace {

/// A reader with a receive buffer of the usual 208 KiB loses datagrams of an image while its computer is busy, and asks
/// for them again. Until they have arrived, the writer must not replace the image by newer ones. ROS 2's own default.
constexpr int kImageDepth = 10;

RequestClientOptions client_options(const BridgeOptions& options) {
  RequestClientOptions client;
  client.source = unique_source("ros_bridge");
  client.level = options.level;
  client.robot_id = options.robot_id;
  return client;
}

dds::Entity create_ros_domain(const BridgeOptions& options) {
  if (options.ros_domain == options.run.domain) return {};
  return dds::create_domain(options.ros_domain,
                            options.ros_localhost_only ? dds::Reach::kLoopback : dds::Reach::kNetwork);
}

/// A participant of its own, because ROS 2 knows its participants by their user data.
dds::Entity create_ros_participant(const BridgeOptions& options) {
  const dds::Qos qos = dds::make_qos();
  dds_qset_userdata(qos.get(), kRosParticipant, std::char_traits<char>::length(kRosParticipant));
  if (options.ros_domain != options.run.domain)
    return {dds_create_participant(options.ros_domain, qos.get(), nullptr), "dds_create_participant"};
  dds::Entity participant = dds::create_participant(options.run.domain, dds::Reach::kLoopback, {});  // also if secured
  dds::check(dds_set_qos(participant.get(), qos.get()), "dds_set_qos");
  return participant;
}

}  // namespace

Bridge::Bridge(const BridgeOptions& options, const RobotModel& robot, constrictor::Log log)
    : options_(options),
      own_log_(std::move(log)),
      joint_count_(robot.joints.size()),
      translator_(robot),
      drawing_(robot.module_radius_m),
      health_(robot.name),
      client_(options.run.domain, client_options(options)),
      monitor_(options.run, client_.participant()),
      ros_domain_(create_ros_domain(options)),
      ros_participant_(create_ros_participant(options)),
      node_(ros_participant_.get(), "ros_bridge", options.release),
      pilot_(options.hold_after_s) {
  // ROS 2's readers ask for reliable or best effort, volatile or (tf_static) transient-local: the QoS of these writers
  // matches all of them. Keep-last writers never wait for a reader.
  clock_out_ = node_.writer<Clock>("clock", 1);
  joints_out_ = node_.writer<JointState>("joint_states", 10);
  imu_out_ = node_.writer<Imu>("imu", 10);
  odom_out_ = node_.writer<Odometry>("odom", 10);
  tf_out_ = node_.writer<TFMessage>("tf", 10);
  tf_static_out_ = node_.writer<TFMessage>("tf_static", 1);
  image_out_ = node_.writer<Image>("camera/image_raw", kImageDepth);
  camera_info_out_ = node_.writer<CameraInfo>("camera/camera_info", 10);  // small, and an image is useless without it
  percept_image_out_ = node_.writer<Image>("perception/image", kImageDepth);
  overview_image_out_ = node_.writer<Image>("overview/image", kImageDepth);
  map_markers_out_ = node_.writer<MarkerArray>("markers/map", 1);
  line_markers_out_ = node_.writer<MarkerArray>("markers/line_in_view", 1);
  object_markers_out_ = node_.writer<MarkerArray>("markers/objects_in_view", 1);
  line_out_ = node_.writer<Path>("line", 1);
  plan_out_ = node_.writer<Path>("plan", 1);
  diagnostics_out_ = node_.writer<DiagnosticArray>("diagnostics", 1);
  log_out_ = node_.writer<Log>("rosout", 256);
  stopped_out_ = node_.writer<std_msgs_msg_dds__Bool_>("emergency_stop/state", 1);
  task_answer_out_ = node_.writer<Text>("task/answer", 16);
  task_status_out_ = node_.writer<Text>("task/status", 1);
  task_event_out_ = node_.writer<Text>("task/event", 64);
  description_out_ = node_.writer<Text>("robot_description", 1);
  using enum Node::Reliability;
  velocity_ = node_.reader<Twist>("cmd_vel", 1, kBestEffort);
  // A stop must not be lost, and it must match every writer. A stop that arrives at both readers is one stop.
  stop_ = node_.reader<Empty>("emergency_stop", 1, kReliable);
  best_effort_stop_ = node_.reader<Empty>("emergency_stop", 1, kBestEffort);
  clear_stop_ = node_.reader<Empty>("emergency_stop/clear", 1, kReliable);
  task_ = node_.reader<Text>("task/request", 16, kReliable);
  node_.announce();
  say(description_out_, urdf_model(robot));

  const dds_entity_t robot_side = client_.participant();
  tick_ = dds::Reader<msg::Tick>::observer(robot_side, "barrier/tick", 8);
  joints_ = dds::Reader<msg::JointState>::observer(robot_side, "joint_state", 8);
  imu_ = dds::Reader<msg::ImuState>::observer(robot_side, "imu_state", 8);
  pose_ = dds::Reader<msg::RobotPose>::observer(robot_side, "guidance/pose", 8);
  camera_image_ = dds::Reader<msg::CameraImage>::observer(robot_side, "camera/image", 2);
  percept_image_ = dds::Reader<msg::CameraImage>::observer(robot_side, "perception/image", 2);
  overview_image_ = dds::Reader<msg::CameraImage>::observer(robot_side, "overview/image", 2);
  line_percept_ = dds::Reader<msg::LinePercept>::observer(robot_side, "perception/line", 2);
  object_percepts_ = dds::Reader<msg::ObjectPercepts>::observer(robot_side, "perception/objects", 2);
  map_ = dds::Reader<msg::FieldMap>::observer(robot_side, "guidance/map", 1);
  component_status_ = dds::Reader<msg::ComponentStatus>::observer(robot_side, "component_status", 4);
  task_status_ = dds::Reader<msg::TaskStatus>::observer(robot_side, "task/status", 4);
  // Written seldom: a member's reader also receives what was written before this process started.
  camera_info_ = dds::Reader<msg::CameraInfo>::member(robot_side, "camera/info");
  task_command_ = dds::Reader<msg::TaskCommand>::member(robot_side, "task/command");
  task_event_ = dds::Reader<msg::TaskEvent>::member(robot_side, "task/event");
  log_ = dds::Reader<msg::LogLine>::member(robot_side, "log");
  wait_set_ = dds::WaitSet(robot_side);
  for (const auto reader : {tick_.get(), joints_.get(), imu_.get(), pose_.get(), camera_info_.get(),
                            camera_image_.get(), percept_image_.get(), overview_image_.get()}) {
    wait_set_.attach(reader);
  }
}

void Bridge::serve(SteadyClock::time_point now) {
  monitor_.poll();
  take_stops(now);
  pass_robot();
  pass_images();
  pass_surroundings();
  take_velocities(now);
  take_task_lines(now);
  pass_tasks();
  pass_health(now);
  wait_set_.wait(20ms);  // a wait set serves one participant; the participant of ROS 2 is polled
}

void Bridge::drop(const std::string& reason) {
  if (counts_.dropped == 0) own_log_.warning("dropped {} (/diagnostics counts later ones)", reason);
  ++counts_.dropped;
  counts_.last_reason = "dropped " + reason;
}

template <class T, class Use>
void Bridge::take_fit(const dds::Reader<T>& reader, Use&& use) {
  reader.take([&](const T& message) {
    const std::string reason = unfit(message);
    if (reason.empty()) return use(message);
    drop("a message that ROS 2 cannot represent: " + reason);
  });
}

void Bridge::pass_robot() {
  take_fit(tick_, [this](const msg::Tick& tick) {
    health_.take(tick);
    period_ns_ = tick.period_ns;
    clock_out_.write(translator_.clock(tick.time_ns));
  });
  take_fit(imu_, [this](const msg::ImuState& imu) {
    last_imu_ = imu;
    imu_out_.write(translator_.imu(imu));
  });
  take_fit(joints_, [this](const msg::JointState& joints) {
    if (joints.joint_count != joint_count_) {
      return drop("joint_state: found " + std::to_string(joints.joint_count) + " joints, but the robot file has " +
                  std::to_string(joint_count_) + "; name the robot file of the run with --robot");
    }
    last_joints_ = joints;
    joints_out_.write(translator_.joint_state(joints));
  });
  take_fit(pose_, [this](const msg::RobotPose& pose) {
    odom_out_.write(translator_.odometry(pose, last_imu_));
    tf_out_.write(translator_.transforms(pose, last_joints_));
  });
  take_fit(camera_info_, [this](const msg::CameraInfo& info) {
    camera_info_out_.write(translator_.camera_info(info));
    tf_static_out_.write(translator_.camera_transform(info));
    last_info_ = info;
  });
}

void Bridge::take_image(const dds::Reader<msg::CameraImage>& reader, const dds::Writer<Image>& writer,
                        const char* frame) {
  take_fit(reader, [&](const msg::CameraImage& image) { writer.write(translator_.image(image, frame)); });
}

void Bridge::pass_images() {
  take_fit(camera_image_, [this](const msg::CameraImage& image) {
    if (!last_info_) return;  // ROS pairs images with infos of the same stamp; there is no info for this image yet
    const Image out = translator_.image(image);
    image_out_.write(out);
    CameraInfo info = translator_.camera_info(*last_info_);
    info.header.stamp = out.header.stamp;
    camera_info_out_.write(info);
  });
  take_image(percept_image_, percept_image_out_, kCameraFrame);
  take_image(overview_image_, overview_image_out_, "overview");
}

void Bridge::pass_surroundings() {
  take_fit(map_, [this](const msg::FieldMap& map) {
    map_markers_out_.write(drawing_.map(map));
    line_out_.write(drawing_.line(map));
  });
  take_fit(line_percept_,
           [this](const msg::LinePercept& line) { line_markers_out_.write(drawing_.line_in_view(line)); });
  take_fit(object_percepts_, [this](const msg::ObjectPercepts& objects) {
    object_markers_out_.write(drawing_.objects_in_view(objects));
  });
  take_fit(task_command_, [this](const msg::TaskCommand& command) {
    plan_out_.write(drawing_.plan(command));
    plan_goal_ = command.task == msg::kTaskFollowPath ? command.goal_id : 0;
  });
}

void Bridge::pass_health(SteadyClock::time_point now) {
  // Lines that the run keeps for late readers wait for the first tick, from which their times follow.
  if (period_ns_ > 0)
    take_fit(log_, [this](const msg::LogLine& line) { log_out_.write(translator_.log(line, period_ns_)); });
  component_status_.take([this](const msg::ComponentStatus& status) { health_.take(status); });
  if (now - health_told_ < 1s) return;
  health_told_ = now;
  if (monitor_.state()) health_.take(*monitor_.state());
  if (counts_.refused != desk_.refused()) counts_.last_reason = "refused a request: " + desk_.last_reason();
  counts_.refused = desk_.refused();
  counts_.unanswered = desk_.waiting().size();
  diagnostics_out_.write(health_.report(counts_));
}

bool Bridge::leave() { return !client_.holds_authority() || client_.release(std::chrono::seconds(2)); }

}  // namespace constrictor::ros_bridge
