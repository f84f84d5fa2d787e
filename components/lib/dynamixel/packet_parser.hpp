// Finds the packets in the bytes of a serial line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "dynamixel/protocol.hpp"

namespace constrictor::dynamixel {

/// Takes bytes in pieces of any size, and returns the packets whose CRC is right. Bytes that belong to no packet
/// (noise, the rest of a damaged packet) are skipped. A packet that was cut off does not hide the one that follows it:
/// the header cannot occur inside of a stuffed packet, so it marks the beginning of the next one. The answer to a Fast
/// Sync Read has no stuffing; only its length and its CRC delimit it. The memory is bounded by kLargestLength and the
/// largest piece.
class PacketParser {
 public:
  /// Counts of the packets and errors on the line since the beginning.
  struct Counters {
    std::uint64_t packets = 0;
    std::uint64_t skipped_bytes = 0;  ///< bytes of no valid packet
    std::uint64_t crc_errors = 0;
    std::uint64_t malformed = 0;  ///< impossible id or length, wrong stuffing, or cut off by the next packet
  };

  void add(ByteView bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }
  /// The next packet; empty: it needs more bytes. The view is valid until the next call of a member function.
  [[nodiscard]] std::optional<PacketView> next();
  /// Forgets the bytes that belong to no complete packet; they count as skipped. For the end of a wait for an answer.
  void clear();
  /// Number of bytes that wait for the rest of their packet.
  [[nodiscard]] std::size_t waiting() const { return buffer_.size() - begin_; }
  /// The bytes that wait for the rest of their packet.
  [[nodiscard]] ByteView rest() const { return ByteView(buffer_).subspan(begin_); }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool may_begin(std::size_t at) const;
  void skip(std::size_t count);
  /// False if the bytes from begin_ on are not packet: some of them were skipped.
  [[nodiscard]] bool check_body(std::size_t length);
  void unstuff(std::size_t length);

  Bytes buffer_;
  std::size_t begin_ = 0;  ///< of the bytes in buffer_ that were not used yet
  Bytes body_;             ///< instruction and parameters of the last packet, without stuffing
  Counters counters_;
};

}  // namespace constrictor::dynamixel
