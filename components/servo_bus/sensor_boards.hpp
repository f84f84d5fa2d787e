// The inertial unit and the contact sensors on the buses (dynamixel/sensor_board.hpp).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"
#include "servo_bus/bus_ports.hpp"

namespace constrictor {

class SensorBoards {
 public:
  /// Both must outlive this object.
  SensorBoards(const dynamixel::BusPlan& plan, BusPorts& ports) : plan_(plan), ports_(ports) {}

  /// Empty: the robot has no inertial unit, or it did not answer in this tick. The yaw is relative to the first
  /// reading.
  [[nodiscard]] std::optional<msg::ImuState> imu();
  /// `module_count` is 0 if the robot has no contact sensors, or if not all of them answered. So no reader takes a
  /// missing contact for an untouched skin.
  [[nodiscard]] msg::ContactState contacts();
  /// [rad] yaw of the board at the first reading, which a successor needs; NaN before it.
  [[nodiscard]] double start_yaw_rad() const { return start_yaw_rad_; }
  void set_start_yaw(double yaw_rad) { start_yaw_rad_ = yaw_rad; }
  /// The events since the last call.
  [[nodiscard]] std::vector<BusNews> take_news() { return std::exchange(news_, {}); }

 private:
  struct Watched {
    int misses = 0;  ///< ticks without an answer
    bool missing = false;
  };
  /// Notes when a sensor is lost, and when it is back.
  void note(const char* what, std::size_t port, Watched& board, bool answered);
  /// Whether a board that is missing is left out in this tick.
  [[nodiscard]] bool skip(const Watched& board);

  const dynamixel::BusPlan& plan_;
  BusPorts& ports_;
  int skipped_ = 0;
  double start_yaw_rad_ = std::numeric_limits<double>::quiet_NaN();
  Watched imu_;
  Watched contacts_;
  std::vector<BusNews> news_;
};

}  // namespace constrictor
