// The boards with sensors, answered by a port that the test fills.
#include "servo_bus/sensor_boards.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "dynamixel/sensor_board.hpp"

namespace constrictor {
namespace {

using dynamixel::Bytes;
namespace map = dynamixel::sensor_board;

/// Answers every question with the same data of device 100.
class BoardPort final : public serial::Port {
 public:
  explicit BoardPort(const Bytes& data) : data_(data) {}
  void write(dynamixel::ByteView) override { dynamixel::put_status(waiting_, 100, 0, data_); }
  [[nodiscard]] bool read(Bytes& to, std::int64_t deadline_ns) override {
    if (waiting_.empty()) now_ns_ = std::max(now_ns_, deadline_ns);
    to.insert(to.end(), waiting_.begin(), waiting_.end());
    return !std::exchange(waiting_, {}).empty();
  }
  void drop_input() override { waiting_.clear(); }
  [[nodiscard]] std::int64_t now_ns() const override { return now_ns_; }
  [[nodiscard]] std::uint32_t baud() const override { return 4'000'000; }

 private:
  const Bytes& data_;
  Bytes waiting_;
  std::int64_t now_ns_ = 1;
};

class Boards : public ::testing::Test {
 protected:
  Boards() {
    plan_.ports = {{"bus0", 4'000'000}};
    plan_.imu = dynamixel::SensorBoard{0, 100};
    ports_.open_all(0.0);
  }
  void turn_to(const Eigen::Quaterniond& q) {
    data_.clear();
    dynamixel::put_number(data_, 1, 2);
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) dynamixel::put_number(data_, std::lround(part * 32767), 2);
    for (const double rate : {0.5, -1.0, 2.0}) dynamixel::put_number(data_, std::lround(rate * 1000), 2);
    for (const double acceleration : {0.0, -3.0, 9.81})
      dynamixel::put_number(data_, std::lround(acceleration * 200), 2);
  }
  static Eigen::Quaterniond pose(double yaw_rad, double pitch_rad) {
    return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) * Eigen::Quaterniond::Identity();
  }
  static Eigen::Quaterniond eigen(const msg::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

  dynamixel::BusPlan plan_;
  Bytes data_;
  BusPorts ports_{{{"bus0", 4'000'000}}, 0.004, [this](const dynamixel::BusPort&, double) {
                    return std::make_unique<BoardPort>(data_);
                  }};
  SensorBoards boards_{plan_, ports_};
};

TEST_F(Boards, TheYawIsRelativeToTheFirstReading) {
  turn_to(pose(2.0, 0.3));
  auto state = boards_.imu();
  ASSERT_TRUE(state);
  EXPECT_LT(eigen(state->orientation).angularDistance(pose(0.0, 0.3)), 1e-3);
  EXPECT_NEAR(boards_.start_yaw_rad(), 2.0, 1e-3);
  turn_to(pose(2.5, -0.1));
  state = boards_.imu();
  ASSERT_TRUE(state);
  EXPECT_LT(eigen(state->orientation).angularDistance(pose(0.5, -0.1)), 1e-3);
  EXPECT_NEAR(state->angular_velocity_rad_s.y, -1.0, 1e-9);
  EXPECT_NEAR(state->linear_acceleration_m_s2.y, -3.0, 1e-9);
}

TEST_F(Boards, AnOrientationThatIsNoneIsNotPublished) {
  turn_to(Eigen::Quaterniond(0.5, 0.0, 0.0, 0.0));
  EXPECT_FALSE(boards_.imu());
  EXPECT_TRUE(boards_.take_news().empty());
  static_cast<void>(boards_.imu());
  static_cast<void>(boards_.imu());
  const auto news = boards_.take_news();
  ASSERT_EQ(news.size(), 1u) << "three ticks without a measurement";
  EXPECT_NE(news[0].text.find("the inertial unit at bus0 does not answer"), std::string::npos) << news[0].text;
}

TEST_F(Boards, ARobotWithoutContactSensorsSaysSo) { EXPECT_EQ(boards_.contacts().module_count, 0); }

}  // namespace
}  // namespace constrictor
