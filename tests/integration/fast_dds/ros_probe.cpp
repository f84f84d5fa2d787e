// ros_probe: acts as a ROS 2 node on another vendor's DDS with ROS's topic and type names. It prints a line for each
// sample; with --drive it writes velocities, as teleop_twist_keyboard does.
//   ros_probe --domain N --for SECONDS [--drive SPEED,TURN]
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "participant.hpp"
#include "ros_typesPubSubTypes.h"

namespace {

volatile std::sig_atomic_t g_stop = 0;

template <class Stamp>
long long ns(const Stamp& stamp) {
  return stamp.sec() * 1'000'000'000LL + stamp.nanosec();
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  unsigned domain = 0;
  double seconds = 5, speed_m_s = 0, turn_rad_s = 0;
  bool drive = false;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!std::strcmp(argv[i], "--domain")) domain = static_cast<unsigned>(std::atoi(argv[i + 1]));
    if (!std::strcmp(argv[i], "--for")) seconds = std::atof(argv[i + 1]);
    if (!std::strcmp(argv[i], "--drive")) drive = std::sscanf(argv[i + 1], "%lf,%lf", &speed_m_s, &turn_rad_s) == 2;
  }
  namespace sensor = sensor_msgs::msg::dds_;
  example::Participant node(domain, "ros_probe");
  node.read<rosgraph_msgs::msg::dds_::Clock_PubSubType>(
      "rt/clock", false, 10, [](const auto& m) { std::printf("clock %lld\n", ns(m.clock())); });
  node.read<sensor::JointState_PubSubType>("rt/joint_states", false, 10, [](const auto& m) {
    std::printf("joint_states %lld", ns(m.header().stamp()));
    for (std::size_t i = 0; i < m.name().size(); ++i) std::printf(" %s=%.17g", m.name()[i].c_str(), m.position().at(i));
    std::printf("\n");
  });
  node.read<sensor::Imu_PubSubType>("rt/imu", false, 10, [](const auto& m) {
    std::printf("imu %lld %s %.17g\n", ns(m.header().stamp()), m.header().frame_id().c_str(),
                m.linear_acceleration().z());
  });
  node.read<nav_msgs::msg::dds_::Odometry_PubSubType>("rt/odom", false, 10, [](const auto& m) {
    std::printf("odom %lld %s %s %.17g %.17g\n", ns(m.header().stamp()), m.header().frame_id().c_str(),
                m.child_frame_id().c_str(), m.pose().pose().position().x(), m.pose().pose().position().y());
  });
  const auto print_tf = [](const char* name) {
    return [name](const tf2_msgs::msg::dds_::TFMessage_& m) {
      std::printf("%s", name);
      for (const auto& t : m.transforms())
        std::printf(" %s>%s", t.header().frame_id().c_str(), t.child_frame_id().c_str());
      std::printf("\n");
    };
  };
  node.read<tf2_msgs::msg::dds_::TFMessage_PubSubType>("rt/tf", false, 10, print_tf("tf"));
  node.read<tf2_msgs::msg::dds_::TFMessage_PubSubType>("rt/tf_static", true, 10, print_tf("tf_static"));
  node.read<sensor::Image_PubSubType>("rt/camera/image_raw", true, 2, [](const auto& m) {
    unsigned long sum = 0;
    for (const auto byte : m.data()) sum += byte;
    std::printf("image %lld %ux%u %s %zu %lu\n", ns(m.header().stamp()), m.width(), m.height(), m.encoding().c_str(),
                m.data().size(), sum);
  });
  node.read<sensor::CameraInfo_PubSubType>("rt/camera/camera_info", true, 10, [](const auto& m) {
    std::printf("camera_info %lld %ux%u %s fx=%.6f\n", ns(m.header().stamp()), m.width(), m.height(),
                m.distortion_model().c_str(), m.k()[0]);
  });
  auto* velocity = drive ? node.write<geometry_msgs::msg::dds_::Twist_PubSubType>("rt/cmd_vel", 1, false) : nullptr;

  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (auto next = Clock::now(); !g_stop && Clock::now() < end;) {
    node.wait(0.05);
    std::fflush(stdout);
    if (!velocity || Clock::now() < next) continue;
    next = Clock::now() + std::chrono::milliseconds(100);
    geometry_msgs::msg::dds_::Twist_ twist;
    twist.linear().x(speed_m_s);
    twist.angular().z(turn_rad_s);
    velocity->write(&twist);
  }
}
