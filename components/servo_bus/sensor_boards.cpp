#include "servo_bus/sensor_boards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamixel/sensor_board.hpp"
#include "robot/planar_message.hpp"

namespace constrictor {

using dynamixel::Bytes;
using dynamixel::ByteView;
namespace map = dynamixel::sensor_board;

namespace {

constexpr std::int64_t kTimeToAskAgain_ns = 8'000'000;
constexpr int kMissingAfter = 3;  // ticks without an answer
constexpr int kAskEvery = 10;     // ticks, of a board that is missing: waiting for it must not delay the ticks

/// Measurements of a board, addressed as its registers are.
class BoardData {
 public:
  explicit BoardData(ByteView data) : data_(data) {}
  [[nodiscard]] double number(std::size_t address, double unit) const {
    return unit * static_cast<double>(dynamixel::get_number(data_.subspan(address - map::kBegin), 2, true));
  }
  [[nodiscard]] msg::Vector3 vector(std::size_t address, double unit) const {
    return {number(address, unit), number(address + 2, unit), number(address + 4, unit)};
  }
  [[nodiscard]] std::uint8_t byte(std::size_t address) const { return data_[address - map::kBegin]; }

 private:
  ByteView data_;
};

std::optional<msg::Quaternion> unit_quaternion(const BoardData& board) {
  const double w = board.number(map::imu::kOrientation, map::kUnitVector);
  const msg::Vector3 v = board.vector(map::imu::kOrientation + 2, map::kUnitVector);
  const double length = std::sqrt(w * w + v.x * v.x + v.y * v.y + v.z * v.z);
  if (std::abs(length - 1.0) > 0.01) return std::nullopt;
  return msg::Quaternion{w / length, v.x / length, v.y / length, v.z / length};
}

/// The orientation in a level frame that is turned to the left by `yaw_rad`.
msg::Quaternion turned_back(const msg::Quaternion& q, double yaw_rad) {
  const double c = std::cos(0.5 * yaw_rad);
  const double s = -std::sin(0.5 * yaw_rad);
  return {c * q.w - s * q.z, c * q.x - s * q.y, c * q.y + s * q.x, c * q.z + s * q.w};
}

}  // namespace

void SensorBoards::note(const char* what, std::size_t port, Watched& board, bool answered) {
  board.misses = answered ? 0 : board.misses + 1;
  const bool missing = board.misses >= (board.missing ? 1 : kMissingAfter);
  if (missing == board.missing) return;
  board.missing = missing;
  news_.push_back({fmt::format("{} at {} {}", what, ports_.port(port).device,
                               missing ? "does not answer (power, cable, id?)" : "answers again"),
                   !missing});
}

bool SensorBoards::skip(const Watched& board) { return board.missing && ++skipped_ % kAskEvery != 0; }

std::optional<msg::ImuState> SensorBoards::imu() {
  if (!plan_.imu || skip(imu_)) return std::nullopt;
  std::optional<msg::ImuState> state;
  ports_.with(plan_.imu->port, news_, [&](serial::BusMaster& bus) {
    const serial::Answer answer = bus.read(plan_.imu->id, map::kBegin, map::imu::kEnd - map::kBegin, 1);
    if (!answer.good()) return;
    const BoardData board(answer.data);
    const auto orientation = unit_quaternion(board);
    if (!orientation) return;
    state.emplace();
    // A board counts its yaw from when it was switched on, and the messages from the start of the epoch.
    if (std::isnan(start_yaw_rad_)) start_yaw_rad_ = yaw_of(*orientation);
    state->orientation = turned_back(*orientation, start_yaw_rad_);
    state->angular_velocity_rad_s = board.vector(map::imu::kAngularVelocity, map::kRate_rad_s);
    state->linear_acceleration_m_s2 = board.vector(map::imu::kLinearAcceleration, map::kAcceleration_m_s2);
  });
  note("the inertial unit", plan_.imu->port, imu_, state.has_value());
  return state;
}

msg::ContactState SensorBoards::contacts() {
  msg::ContactState state{};
  if (plan_.contact_boards.empty() || skip(contacts_)) return state;
  const std::size_t port = plan_.contact_boards.front().port;  // load_bus_plan: all are at one port
  Bytes ids;
  for (const auto& board : plan_.contact_boards) ids.push_back(board.id);
  std::size_t answered = 0;
  std::vector<msg::Contact> contacts;
  const auto use = [&](std::uint8_t, const serial::Answer& answer) {
    const auto module = static_cast<std::uint8_t>(answered++);
    if (!answer.good()) return;
    const BoardData board(answer.data);
    state.force_n[module] = board.vector(map::contact::kForce, map::kForce_n);
    state.torque_nm[module] = board.vector(map::contact::kMoment, map::kMoment_nm);
    const std::size_t count = std::min<std::size_t>(board.byte(map::contact::kContacts), map::contact::kMost);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = map::contact::kFirst + i * map::contact::kBytesOfOne;
      contacts.push_back({module, board.vector(at, map::kPosition_m), board.vector(at + 6, map::kUnitVector),
                          board.vector(at + 12, map::kForce_n)});
    }
  };
  ports_.with(port, news_, [&](serial::BusMaster& bus) {
    const std::int64_t begin_ns = ports_.now_ns();
    constexpr std::uint16_t kBytes = map::contact::kEnd - map::kBegin;
    if (plan_.fast_sync_read.value_or(true)) bus.fast_sync_read(map::kBegin, kBytes, ids, use);
    else bus.sync_read(map::kBegin, kBytes, ids, use);
    // A damaged answer is known at once, and there is time to ask again; a missing board is not waited for twice.
    const bool in_time = ports_.now_ns() - begin_ns < kTimeToAskAgain_ns;
    if (answered < ids.size() && in_time) bus.sync_read(map::kBegin, kBytes, ByteView(ids).subspan(answered), use);
  });
  const bool all = answered == ids.size();
  note("one of the contact boards", port, contacts_, all);
  if (!all) return {};
  state.module_count = static_cast<std::uint16_t>(ids.size());
  const auto strength = [](const msg::Contact& one) { return std::hypot(one.force_n.x, one.force_n.y, one.force_n.z); };
  std::stable_sort(contacts.begin(), contacts.end(),
                   [&](const msg::Contact& a, const msg::Contact& b) { return strength(a) > strength(b); });
  state.contact_count = static_cast<std::uint16_t>(std::min<std::size_t>(contacts.size(), msg::kMaxContacts));
  std::copy_n(contacts.begin(), state.contact_count, state.contacts);
  return state;
}

}  // namespace constrictor
