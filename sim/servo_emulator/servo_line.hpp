// One emulated serial line with its devices: it takes the bytes of the controller, and answers byte by byte as the
// devices would, with the time of each byte. Pure: time is an argument.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "component/random.hpp"
#include "dynamixel/packet_parser.hpp"
#include "sim/servo_emulator/bus_device.hpp"

namespace constrictor::servo_emulator {

/// The faults of the line. Changes act at once.
struct LineFaults {
  std::optional<std::size_t> cable_broken_behind;  ///< the devices after this place in the chain are gone
  std::vector<std::size_t> silent;                 ///< places of devices that neither receive nor answer
  double damaged_bytes = 0.0;                      ///< probability that a byte of an answer is damaged
  double cut_answers = 0.0;                        ///< probability that an answer ends somewhere in the middle
  bool unplugged = false;                          ///< the adapter is gone, and with it the serial port
  double noise_answers = 0.0;                      ///< probability that random bytes precede an answer
};

class ServoLine {
 public:
  /// `devices`: along the cable, from the controller on. They must outlive the line.
  ServoLine(std::vector<BusDevice*> devices, std::uint64_t seed)
      : devices_(std::move(devices)), random_(seed, "line") {}

  /// Takes bytes that the controller has sent at this baud rate; devices with another rate ignore them. The last byte
  /// is on the line for its own time after `now_ns`.
  void receive(dynamixel::ByteView bytes, std::uint32_t baud, std::int64_t now_ns);

  /// Bytes of an answer, which are complete at `at_ns`.
  struct Transmission {
    std::int64_t at_ns = 0;
    dynamixel::Bytes bytes;
  };
  /// The answers that are not taken yet, in the order of their time.
  [[nodiscard]] std::deque<Transmission>& outgoing() { return outgoing_; }

  LineFaults faults;

 private:
  struct Reply {
    std::int64_t delay_ns = 0;
    dynamixel::Bytes bytes;
  };
  [[nodiscard]] std::vector<BusDevice*> hearing() const;
  void obey(const dynamixel::PacketView& packet);
  void answer_ping(BusDevice& device);
  void answer_one(BusDevice& device, const dynamixel::PacketView& packet);
  void answer_sync_read(const dynamixel::PacketView& packet);
  void answer_fast_sync_read(const dynamixel::PacketView& packet);
  void sync_write(const dynamixel::PacketView& packet);
  [[nodiscard]] BusDevice* find(std::uint8_t id) const;
  void send(std::int64_t delay_ns, const dynamixel::Bytes& bytes);
  void spoil(dynamixel::Bytes& bytes);

  std::vector<BusDevice*> devices_;
  Random random_;
  dynamixel::PacketParser parser_;
  std::uint32_t baud_ = 0;
  std::int64_t free_ns_ = 0;  ///< when the last byte that is known now has left the line
  std::deque<Transmission> outgoing_;
};

}  // namespace constrictor::servo_emulator
