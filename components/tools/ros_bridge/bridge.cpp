#include "ros_bridge/bridge.hpp"

#include <cstdio>
#include <utility>

namespace constrictor::ros {

using namespace std::chrono_literals;

namespace {
RequestClientOptions client_options(const BridgeOptions& options) {
  RequestClientOptions client;
  client.source = unique_source("ros_bridge");
  client.level = options.level;
  client.robot_id = options.robot_id;
  return client;
}

}  // namespace

Bridge::Bridge(const BridgeOptions& options, RobotModel robot)
    : options_(options),
      translator_(std::move(robot)),
      client_(options.domain, client_options(options)),
      pilot_(options.hold_after_s) {
  const dds_entity_t robot_side = client_.participant();
  if (options.ros_domain != options.domain) {
    other_domain_.emplace(options.ros_domain,
                          options.ros_localhost_only ? dds::Reach::kLoopback : dds::Reach::kNetwork);
  }
  const dds_entity_t ros_side = other_domain_ ? other_domain_->participant() : robot_side;
  // ROS 2's readers ask for reliable or best effort, volatile or (tf_static) transient-local: the QoS of these writers
  // matches all of them. Keep-last writers never wait for a reader.
  clock_out_ = {ros_side, "rt/clock", 1};
  joints_out_ = {ros_side, "rt/joint_states", 10};
  imu_out_ = {ros_side, "rt/imu", 10};
  odom_out_ = {ros_side, "rt/odom", 10};
  tf_out_ = {ros_side, "rt/tf", 10};
  tf_static_out_ = {ros_side, "rt/tf_static", 1};
  image_out_ = {ros_side, "rt/camera/image_raw", 2};
  camera_info_out_ = {ros_side, "rt/camera/camera_info", 10};  // small, and an image is useless without it
  velocity_ = dds::Reader<Twist>::observer(ros_side, "rt/cmd_vel");

  tick_ = dds::Reader<msg::Tick>::observer(robot_side, "barrier/tick", 8);
  joints_ = dds::Reader<msg::JointState>::observer(robot_side, "joint_state", 8);
  imu_ = dds::Reader<msg::ImuState>::observer(robot_side, "imu_state", 8);
  pose_ = dds::Reader<msg::RobotPose>::observer(robot_side, "guidance/pose", 8);
  camera_image_ = dds::Reader<msg::CameraImage>::observer(robot_side, "camera/image", 2);
  // Written once an epoch: a member's reader also receives what was written before this process started.
  camera_info_ = dds::Reader<msg::CameraInfo>::member(robot_side, "camera/info");
  wait_set_ = dds::WaitSet(robot_side);
  for (const auto reader :
       {tick_.get(), joints_.get(), imu_.get(), pose_.get(), camera_info_.get(), camera_image_.get()}) {
    wait_set_.attach(reader);
  }
  if (!other_domain_) wait_set_.attach(velocity_.get());
}

bool Bridge::over() const { return over_ || (met_ && tick_.writers() == 0); }

void Bridge::serve(SteadyClock::time_point now) {
  pass_out();
  pass_velocity(now);
  wait_set_.wait(20ms);  // a wait set serves one domain; the other domain is polled
}

template <class T, class Use>
void Bridge::take_fit(const dds::Reader<T>& reader, Use&& use) {
  reader.take([&](const T& message) {
    const std::string reason = unfit(message);
    if (reason.empty()) return use(message);
    if (!dropped_)
      std::fprintf(stderr,
                   "ros_bridge: dropped a message that ROS 2 cannot represent: %s (later ones are dropped silently)\n",
                   reason.c_str());
    dropped_ = true;
  });
}

void Bridge::pass_out() {
  take_fit(tick_, [this](const msg::Tick& tick) {
    met_ = true;
    over_ = over_ || tick.final_tick;
    clock_out_.write(translator_.clock(tick.time_ns));
  });
  take_fit(imu_, [this](const msg::ImuState& imu) {
    last_imu_ = imu;
    imu_out_.write(translator_.imu(imu));
  });
  take_fit(joints_, [this](const msg::JointState& joints) {
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
  take_fit(camera_image_, [this](const msg::CameraImage& image) {
    if (!last_info_) return;  // ROS pairs images with infos of the same stamp; there is no info for this image yet
    const Image out = translator_.image(image);
    image_out_.write(out);
    CameraInfo info = translator_.camera_info(*last_info_);
    info.header.stamp = out.header.stamp;
    camera_info_out_.write(info);
  });
}

void Bridge::pass_velocity(SteadyClock::time_point now) {
  const double now_s = std::chrono::duration<double>(now.time_since_epoch()).count();
  velocity_.take([&](const Twist& twist) { pilot_.command(drive_of(twist, options_.drive), now_s); });
  client_.poll();
  if (const msg::RequestAnswer* answer = client_.answer(number_)) {
    number_ = 0;
    pilot_.answered(answer->granted);
    if (answer->granted) refusal_.clear();
    else if (refusal_ != answer->reason)
      std::fprintf(stderr, "ros_bridge: cmd_vel is refused: %s\n", (refusal_ = answer->reason).c_str());
  }
  if (client_.authority()) pilot_.authority(client_.holds_authority(), client_.authority()->emergency_stop, now_s);
  if (const auto request = pilot_.next(client_.connected(), velocity_.writers() > 0, now_s)) {
    if (request->kind != msg::kRequestMotion) number_ = client_.ask(request->kind);
    else if (request->drive == Drive{}) number_ = client_.move(msg::kMotionStand);
    else number_ = client_.move(msg::kMotionDrive, request->drive.frequency_hz, request->drive.curvature_1_m);
  }
}

bool Bridge::leave() { return !client_.holds_authority() || client_.release(std::chrono::seconds(2)); }

}  // namespace constrictor::ros
