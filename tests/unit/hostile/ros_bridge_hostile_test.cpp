// Messages of the robot with absurd values at the bridge to ROS 2: messages to ROS are finite and consistent, and
// memory does not grow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "component/data_path.hpp"
#include "constrictor/messages.hpp"
#include "hostile_filler.hpp"
#include "resident_memory.hpp"
#include "robot/robot_model.hpp"
#include "ros_bridge/ros_drawing.hpp"
#include "ros_bridge/ros_translator.hpp"

namespace constrictor::testing {
namespace {

bool finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}
bool finite(const geometry_msgs_msg_dds__Vector3_& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const geometry_msgs_msg_dds__Point_& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const dds_sequence_double& values) {
  return finite(std::span<const double>(values._buffer, values._length));
}
bool unit(const geometry_msgs_msg_dds__Quaternion_& q) {
  return std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0) < 0.02;
}
/// Whether ROS's own libraries accept it as a time.
bool in_time(const builtin_interfaces_msg_dds__Time_& t) { return t.sec >= 0 && t.nanosec < 1'000'000'000u; }

/// Messages with absurd values, most of which the bridge nevertheless accepts for translation.
class RosFiller : public HostileFiller {
 public:
  using HostileFiller::HostileFiller;
  template <class T>
  T make() {
    T message{};
    begin_message();
    Description<T>::visit(message, *this);
    if constexpr (requires { message.header; }) {
      if (roll(4) != 0) make_relevant(message.header.tick, message.header.time_ns);
    } else {
      if (roll(4) != 0) make_relevant(message.index, message.time_ns);
    }
    make_relevant(message);
    return message;
  }

 private:
  void make_relevant(std::int64_t& tick, std::int64_t& time_ns) {
    tick = static_cast<std::int64_t>(roll(1'000'000'000));
    time_ns = tick * 20'000'000;
  }
  template <class T>
  void make_relevant(T&) {}
  void make_relevant(msg::ImuState& m) { make_relevant(m.orientation); }
  void make_relevant(msg::CameraInfo& m) { make_relevant(m.X_HC.orientation); }
  void make_relevant(msg::Quaternion& q) {
    if (roll(4) != 0) q = {std::cos(static_cast<double>(roll(7))), 0.0, 0.0, 0.0};
    if (roll(4) != 0) q.z = std::sqrt(std::max(0.0, 1.0 - q.w * q.w));
  }
  void make_relevant(msg::CameraImage& m) {
    if (roll(4) == 0) return;
    m.width = static_cast<std::uint16_t>(1 + roll(32));
    m.height = static_cast<std::uint16_t>(1 + roll(16));
    const auto length = static_cast<std::uint32_t>(roll(4) == 0 ? roll(pixels_.size()) : m.width * m.height * 3u);
    m.data = {length, length, pixels_.data(), false};
    make_exposed(m);
  }
  void make_relevant(msg::LinePercept& m) { make_exposed(m); }
  void make_relevant(msg::ObjectPercepts& m) { make_exposed(m); }
  template <class T>
  void make_exposed(T& m) {
    if (roll(4) != 0) m.exposure_tick = m.header.tick - static_cast<std::int64_t>(roll(4));
  }
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(32 * 16 * 3);
};

/// Translates the messages that the bridge would translate, and checks the result.
class CheckedTranslator {
 public:
  explicit CheckedTranslator(const RobotModel& robot)
      : joints_(robot.joints.size()), modules_(robot.module_count), translator_(robot) {}
  void translate(const msg::Tick& m) {
    if (fit(m)) {
      ASSERT_TRUE(in_time(translator_.clock(m.time_ns).clock));
    }
  }
  void translate(const msg::JointState& m) {
    if (!fit(m)) return;
    const auto out = translator_.joint_state(last_joints_ = m);
    ASSERT_TRUE(in_time(out.header.stamp));
    ASSERT_LE(out.name._length, joints_);
    for (const auto* values : {&out.position, &out.velocity, &out.effort}) {
      ASSERT_EQ(values->_length, out.name._length);
      ASSERT_TRUE(finite(*values));
    }
  }
  void translate(const msg::ImuState& m) {
    if (!fit(m)) return;
    const auto out = translator_.imu(last_imu_ = m);
    ASSERT_TRUE(in_time(out.header.stamp));
    ASSERT_TRUE(unit(out.orientation) && finite(out.angular_velocity) && finite(out.linear_acceleration));
  }
  void translate(const msg::RobotPose& m) {
    if (!fit(m)) return;
    const auto odometry = translator_.odometry(m, last_imu_);
    const auto& at = odometry.pose.pose;
    ASSERT_TRUE(in_time(odometry.header.stamp) && finite(at.position) && unit(at.orientation));
    ASSERT_TRUE(finite(odometry.pose.covariance) && finite(odometry.twist.twist.linear) &&
                finite(odometry.twist.twist.angular));
    check(translator_.transforms(m, last_joints_), modules_);
  }
  void translate(const msg::CameraInfo& m) {
    if (!fit(m)) return;
    const auto out = translator_.camera_info(m);
    ASSERT_TRUE(in_time(out.header.stamp) && finite(out.k) && finite(out.r) && finite(out.p) && finite(out.d));
    ASSERT_TRUE(out.width > 0 && out.height > 0);
    check(translator_.camera_transform(m), 1);
  }
  void translate(const msg::CameraImage& m) {
    if (!fit(m)) return;
    const auto out = translator_.image(m);
    ASSERT_TRUE(in_time(out.header.stamp));
    ASSERT_EQ(out.step, 3 * out.width);
    ASSERT_EQ(out.data._length, out.step * out.height);
  }
  void translate(const msg::FieldMap& m) {
    if (!fit(m)) return;
    check(drawing_.map(m), "odom");
    check(drawing_.line(m), m.line_point_count);
  }
  void translate(const msg::LinePercept& m) {
    if (fit(m)) check(drawing_.line_in_view(m), "base_link");
  }
  void translate(const msg::ObjectPercepts& m) {
    if (fit(m)) check(drawing_.objects_in_view(m), "base_link");
  }
  void translate(const msg::TaskCommand& m) {
    if (fit(m)) check(drawing_.plan(m), m.path.point_count);
  }
  std::uint64_t translated = 0;

 private:
  static void check(const ros_bridge::MarkerArray& array, const std::string& frame) {
    ASSERT_GE(array.markers._length, 1u);
    for (std::uint32_t i = 0; i < array.markers._length; ++i) {
      const auto& marker = array.markers._buffer[i];
      ASSERT_EQ(marker.header.frame_id, frame);
      ASSERT_TRUE(in_time(marker.header.stamp) && finite(marker.pose.position) && unit(marker.pose.orientation));
      ASSERT_TRUE(finite(marker.scale));
      ASSERT_TRUE(marker.ns && marker.text);
      ASSERT_LE(marker.points._length, 512u);
      for (std::uint32_t k = 0; k < marker.points._length; ++k) ASSERT_TRUE(finite(marker.points._buffer[k]));
    }
  }
  static void check(const ros_bridge::Path& path, std::size_t most) {
    ASSERT_TRUE(in_time(path.header.stamp));
    ASSERT_LE(path.poses._length, most);
    for (std::uint32_t i = 0; i < path.poses._length; ++i) {
      const auto& pose = path.poses._buffer[i].pose;
      ASSERT_TRUE(finite(pose.position) && unit(pose.orientation));
    }
  }
  template <class T>
  bool fit(const T& message) {
    const bool fits = ros_bridge::unfit(message).empty();
    translated += fits;
    return fits;
  }
  static void check(const ros_bridge::TFMessage& tree, std::size_t count) {
    ASSERT_EQ(tree.transforms._length, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& t = tree.transforms._buffer[i];
      ASSERT_TRUE(in_time(t.header.stamp) && finite(t.transform.translation) && unit(t.transform.rotation))
          << t.child_frame_id;
    }
  }

  std::size_t joints_, modules_;
  ros_bridge::Translator translator_;
  ros_bridge::Drawing drawing_{0.035};
  msg::JointState last_joints_{};
  msg::ImuState last_imu_{};
};

template <class T>
void translate(CheckedTranslator& checked, RosFiller& filler) {
  checked.translate(filler.make<T>());
}

TEST(HostileRosBridge, MessagesToRosAreFiniteAndConsistent) {
  constexpr void (*kTranslate[])(CheckedTranslator&, RosFiller&) = {
      translate<msg::Tick>,        translate<msg::JointState>,     translate<msg::ImuState>,
      translate<msg::RobotPose>,   translate<msg::CameraInfo>,     translate<msg::FieldMap>,
      translate<msg::LinePercept>, translate<msg::ObjectPercepts>, translate<msg::TaskCommand>,
      translate<msg::CameraImage>};
  CheckedTranslator checked(load_robot(data_path("components/lib/robot/mamba.yaml")));
  RosFiller filler(kSeed);
  double early_mib = 0.0;
  for (std::uint64_t i = 0; i < kMessages && !::testing::Test::HasFatalFailure(); ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << " message " << i);
    kTranslate[i % std::size(kTranslate)](checked, filler);
    if (i == kMessages / 3) early_mib = resident_mib();
  }
  const double late_mib = resident_mib();
  std::printf("ros_bridge: %llu messages, %llu translated, memory %.1f to %.1f MiB\n",
              static_cast<unsigned long long>(kMessages), static_cast<unsigned long long>(checked.translated),
              early_mib, late_mib);
  EXPECT_GT(checked.translated, kMessages / 10) << "too few messages reached the translator";
  EXPECT_LT(checked.translated, kMessages) << "no message was rejected";
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers keep freed memory
  EXPECT_LT(late_mib - early_mib, 4.0);
#endif
}

}  // namespace
}  // namespace constrictor::testing
