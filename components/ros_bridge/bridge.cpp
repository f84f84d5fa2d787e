#include "ros_bridge/bridge.hpp"

#include <unistd.h>

#include <cstdio>
#include <limits>
#include <utility>

namespace constrictor::ros {

using namespace std::chrono_literals;

namespace {
constexpr std::int64_t kLease_ns = 500'000'000;  // of a bridge that died: then the robot holds
}

Bridge::Bridge(const BridgeOptions& options, RobotModel robot)
    : options_(options), translator_(std::move(robot)), source_("ros_bridge." + std::to_string(::getpid())), robot_side_(options.domain),
      request_(robot_side_.participant(), kLease_ns, /*by_hand=*/false), pilot_(options.hold_after_s) {
  const dds_entity_t robot_side = robot_side_.participant();
  if (options.ros_domain != options.domain) {
    other_domain_.emplace(options.ros_domain, options.ros_localhost_only ? dds::Reach::kLoopback : dds::Reach::kNetwork);
  }
  const dds_entity_t ros_side = other_domain_ ? other_domain_->participant() : robot_side;
  // ROS 2's readers ask for reliable or best effort, volatile or (tf_static) transient-local: this writer's QoS matches them all,
  // and keep-last never waits for one of them.
  clock_out_ = {ros_side, "rt/clock", 1};
  joints_out_ = {ros_side, "rt/joint_states", 10};
  imu_out_ = {ros_side, "rt/imu", 10};
  odom_out_ = {ros_side, "rt/odom", 10};
  tf_out_ = {ros_side, "rt/tf", 10};
  tf_static_out_ = {ros_side, "rt/tf_static", 1};
  image_out_ = {ros_side, "rt/camera/image_raw", 2};
  camera_info_out_ = {ros_side, "rt/camera/camera_info", 10};  // small, and of no use if it is lost to its image
  velocity_ = dds::Reader<Twist>::observer(ros_side, "rt/cmd_vel");

  tick_ = dds::Reader<msg::Tick>::observer(robot_side, "barrier/tick", 8);
  joints_ = dds::Reader<msg::JointState>::observer(robot_side, "joint_state", 8);
  imu_ = dds::Reader<msg::ImuState>::observer(robot_side, "imu_state", 8);
  pose_ = dds::Reader<msg::RobotPose>::observer(robot_side, "guidance/pose", 8);
  camera_image_ = dds::Reader<msg::CameraImage>::observer(robot_side, "camera/image", 2);
  camera_info_ = dds::Reader<msg::CameraInfo>::member(robot_side, "camera/info");  // written once an epoch: also if that was before us
  authority_ = dds::Reader<msg::Authority>::member(robot_side, "authority");
  answers_ = dds::Reader<msg::RequestAnswer>::member(robot_side, "request/answer");
  wait_set_ = dds::WaitSet(robot_side);
  for (const auto reader : {tick_.get(), joints_.get(), imu_.get(), pose_.get(), camera_info_.get(), camera_image_.get()}) {
    wait_set_.attach(reader);
  }
  if (!other_domain_) wait_set_.attach(velocity_.get());
}

bool Bridge::over() const { return over_ || (met_ && tick_.writers() == 0); }

void Bridge::serve(SteadyClock::time_point now) {
  pass_out();
  pass_velocity(now);
  wait_set_.wait(20ms);  // a wait set knows one domain: the other side's commands are looked for so often
}

template <class T, class Use>
void Bridge::take_fit(const dds::Reader<T>& reader, Use&& use) {
  reader.take([&](const T& message) {
    const std::string reason = unfit(message);
    if (reason.empty()) return use(message);
    if (!left_out_) std::fprintf(stderr, "ros_bridge: left out a message that ROS should not see: %s\n", reason.c_str());
    left_out_ = true;
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
    if (!last_info_) return;  // ROS pairs image and info by their stamps: an image that overtook the epoch's info has no partner
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
  answers_.take([&](const msg::RequestAnswer& answer) {
    if (source_ != answer.source || answer.request_sequence != sequence_) return;
    pilot_.answered(answer.granted);
    if (answer.granted) refusal_.clear();
    else if (refusal_ != answer.reason) std::fprintf(stderr, "ros_bridge: cmd_vel is refused: %s\n", (refusal_ = answer.reason).c_str());
  });
  authority_.take([&](const msg::Authority& authority) {
    pilot_.authority(authority.level == options_.level && source_ == authority.source, authority.emergency_stop, now_s);
  });
  if (const auto wish = pilot_.next(request_.heard(), velocity_.writers() > 0, now_s)) ask(wish->kind, wish->drive);
}

void Bridge::ask(std::uint8_t kind, const Drive& drive) {
  msg::Request request{};
  request.robot_id = options_.robot_id;
  dds::set_text(request.source, source_);
  request.header.sequence_number = ++sequence_;
  request.level = options_.level;
  request.kind = kind;
  request.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  request.motion = drive == Drive{} ? msg::kMotionStand : msg::kMotionDrive;
  request.frequency_hz = drive.frequency_hz;
  request.curvature_1_m = drive.curvature_1_m;
  request_.write(request);
}

}  // namespace constrictor::ros
