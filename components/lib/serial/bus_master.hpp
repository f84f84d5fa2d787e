// Questions to the devices at a port, and their answers: with bounds on the time, repetitions, and counts of what went
// wrong.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamixel/instructions.hpp"
#include "dynamixel/packet_parser.hpp"
#include "dynamixel/servo_model.hpp"
#include "serial/port.hpp"

namespace constrictor::serial {

/// The answer of one device.
struct Answer {
  bool arrived = false;  ///< false: no answer within the time
  dynamixel::StatusError error = dynamixel::StatusError::kNone;
  bool alert = false;  ///< the device has a hardware error
  dynamixel::Bytes data;

  [[nodiscard]] bool good() const { return arrived && error == dynamixel::StatusError::kNone; }
  /// Why it is not good, for people.
  [[nodiscard]] std::string text() const {
    return arrived ? dynamixel::text_of(error) : "no answer (check power, cable, id and baud rate)";
  }
};

struct BusCounters {
  std::uint64_t questions = 0;
  std::uint64_t timeouts = 0;    ///< questions without an answer, or with a part of it only
  std::uint64_t retries = 0;     ///< questions that were repeated
  std::uint64_t late_bytes = 0;  ///< bytes that came when nothing was asked
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_received = 0;
};

class BusMaster {
 public:
  /// `slack_s`: time for the adapter and the operating system, in addition to that of the bytes and of the return
  /// delay.
  BusMaster(std::unique_ptr<Port> port, double slack_s) : port_(std::move(port)), slack_s_(slack_s) {}

  // Each question is asked at most `tries` times, until the answer arrives. PortError: the port is gone.
  Answer ping(std::uint8_t id, int tries = 1);
  Answer read(std::uint8_t id, std::uint16_t address, std::uint16_t count, int tries = 2);
  Answer write(std::uint8_t id, std::uint16_t address, dynamixel::ByteView data, int tries = 2);
  Answer reboot(std::uint8_t id, int tries = 1);
  /// All devices that answer a broadcast Ping within the time that 253 devices may need.
  std::vector<std::pair<std::uint8_t, Answer>> ping_all();
  /// The same bytes to all devices, also to those that are not known. No device answers.
  void write_all(std::uint16_t address, dynamixel::ByteView data);
  /// Needs no answer.
  void sync_write(std::uint16_t address, std::uint16_t count, dynamixel::ByteView ids, dynamixel::ByteView data);

  /// Calls `use(id, answer)` for each device that answers, and returns how many did. In the order of `ids`; the devices
  /// after one that does not answer are silent, too.
  using Use = std::function<void(std::uint8_t id, const Answer& answer)>;
  std::size_t sync_read(std::uint16_t address, std::uint16_t count, dynamixel::ByteView ids, const Use& use);
  /// In as many questions as the length of an answer demands.
  std::size_t fast_sync_read(std::uint16_t address, std::uint16_t count, dynamixel::ByteView ids, const Use& use);

  void set_slack(double seconds) { slack_s_ = seconds; }
  /// How long a device may wait before it answers. At first the longest time that a servo can be set to.
  void set_return_delay(double seconds) { return_delay_s_ = seconds; }
  [[nodiscard]] const BusCounters& counters() const { return counters_; }
  [[nodiscard]] const dynamixel::PacketParser::Counters& line() const { return parser_.counters(); }
  [[nodiscard]] Port& port() { return *port_; }
  /// [s] that this number of bytes needs on the line.
  [[nodiscard]] double bytes_s(std::size_t bytes) const { return 10.0 * static_cast<double>(bytes) / port_->baud(); }

 private:
  template <class Put>
  Answer ask(std::uint8_t id, std::size_t answer_bytes, int tries, Put&& put);
  /// Sends question_, and returns when the answer must be there.
  std::int64_t send(double answer_s);
  [[nodiscard]] bool receive(std::int64_t deadline_ns);
  /// One Fast Sync Read.
  std::size_t ask_fast(std::uint16_t address, std::uint16_t count, dynamixel::ByteView ids, const Use& use);
  /// Looks for the answer to a Fast Sync Read in whole_, and calls `use` for its devices. Returns their number.
  std::size_t take_fast_answer(std::uint16_t count, dynamixel::ByteView ids, const Use& use);

  std::unique_ptr<Port> port_;
  double slack_s_;
  dynamixel::PacketParser parser_;
  dynamixel::Bytes question_;
  dynamixel::Bytes received_;
  dynamixel::Bytes whole_;  ///< everything that has arrived since the question
  double return_delay_s_ = 508e-6;
  BusCounters counters_;
};

}  // namespace constrictor::serial
