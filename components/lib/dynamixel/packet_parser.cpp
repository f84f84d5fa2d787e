#include "dynamixel/packet_parser.hpp"

#include <algorithm>

#include "dynamixel/crc16.hpp"

namespace constrictor::dynamixel {
namespace {

constexpr std::size_t kShortestLength = 3;  // instruction and CRC

bool is_fast_answer(std::uint8_t id, std::uint8_t instruction) {
  return id == kBroadcast && instruction == static_cast<std::uint8_t>(Instruction::kStatus);
}

/// Whether FF FF FD begins at this byte.
bool is_pattern(const std::uint8_t* at) { return std::equal(at, at + 3, kHeader.begin()); }

}  // namespace

bool PacketParser::may_begin(std::size_t at) const {
  const std::size_t count = std::min(kHeader.size(), buffer_.size() - at);
  return std::equal(kHeader.begin(), kHeader.begin() + static_cast<std::ptrdiff_t>(count),
                    buffer_.begin() + static_cast<std::ptrdiff_t>(at));
}

void PacketParser::skip(std::size_t count) {
  begin_ += count;
  counters_.skipped_bytes += count;
}

void PacketParser::clear() {
  skip(waiting());
  buffer_.clear();
  begin_ = 0;
}

bool PacketParser::check_body(std::size_t length) {
  const std::uint8_t* head = buffer_.data() + begin_;
  if (waiting() > kHeadBytes && is_fast_answer(head[4], head[kHeadBytes])) return true;
  const std::size_t end = std::min(waiting(), kHeadBytes + length - kCrcBytes);
  for (std::size_t i = kHeadBytes; i + 3 < end; ++i) {
    if (!is_pattern(head + i) || head[i + 3] == 0xFD) continue;
    ++counters_.malformed;
    skip(head[i + 3] == kHeader[3] ? i : 1);
    return false;
  }
  return true;
}

void PacketParser::unstuff(std::size_t length) {
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_ + kHeadBytes);
  const auto last = first + static_cast<std::ptrdiff_t>(length - kCrcBytes);
  body_.clear();
  if (is_fast_answer(buffer_[begin_ + 4], *first)) {
    body_.assign(first, last);
    return;
  }
  for (auto byte = first; byte != last; ++byte) {
    body_.push_back(*byte);
    const bool stuffed = byte - first >= 2 && is_pattern(&*(byte - 2)) && byte + 1 != last;
    if (stuffed) ++byte;  // check_body() has seen that it is FD
  }
}

std::optional<PacketView> PacketParser::next() {
  for (;;) {
    while (waiting() > 0 && !may_begin(begin_)) skip(1);
    if (begin_ > 0 && (waiting() == 0 || begin_ > kLargestLength)) {
      buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
      begin_ = 0;
    }
    if (waiting() < kHeadBytes) return std::nullopt;
    const std::uint8_t* head = buffer_.data() + begin_;
    const std::size_t length = head[5] | std::size_t{head[6]} << 8;
    const bool possible_id = head[4] <= kLargestId || head[4] == kBroadcast;
    if (!possible_id || length < kShortestLength || length > kLargestLength) {
      ++counters_.malformed;
      skip(1);
      continue;
    }
    if (!check_body(length)) continue;
    const std::size_t total = kHeadBytes + length;
    if (waiting() < total) return std::nullopt;
    const std::size_t crc = head[total - 2] | std::size_t{head[total - 1]} << 8;
    if (crc16(ByteView(head, total - kCrcBytes)) != crc) {
      ++counters_.crc_errors;
      skip(1);
      continue;
    }
    unstuff(length);
    const std::uint8_t id = head[4];
    begin_ += total;
    ++counters_.packets;
    return PacketView{id, static_cast<Instruction>(body_[0]), ByteView(body_).subspan(1)};
  }
}

}  // namespace constrictor::dynamixel
