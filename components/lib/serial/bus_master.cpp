#include "serial/bus_master.hpp"

#include <algorithm>

namespace constrictor::serial {

using dynamixel::Bytes;
using dynamixel::ByteView;
using dynamixel::StatusError;

namespace {

constexpr std::size_t kStatusBytes = 11;  // of a status packet without data
constexpr double kPingAllOf_s = 0.003;    // time of each device for its answer to a broadcast Ping (manual)

Answer answer_of(const dynamixel::PacketView& packet) {
  return {true, packet.error(), packet.alert(), Bytes(packet.data().begin(), packet.data().end())};
}

}  // namespace

std::int64_t BusMaster::send(double answer_s) {
  ++counters_.questions;
  counters_.bytes_sent += question_.size();
  // Whatever is left on the line belongs to an earlier question: it must not be taken for the answer to this one.
  received_.clear();
  while (port_->read(received_, 0)) {}
  counters_.late_bytes += received_.size();
  received_.clear();
  parser_.clear();
  port_->write(question_);
  return port_->now_ns() + static_cast<std::int64_t>(1e9 * (bytes_s(question_.size()) + answer_s + slack_s_));
}

bool BusMaster::receive(std::int64_t deadline_ns) {
  received_.clear();
  if (!port_->read(received_, deadline_ns)) return false;
  counters_.bytes_received += received_.size();
  parser_.add(received_);
  return true;
}

template <class Put>
Answer BusMaster::ask(std::uint8_t id, std::size_t answer_bytes, int tries, Put&& put) {
  question_.clear();
  put(question_);
  for (int i = 0; i < tries; ++i) {
    if (i > 0) ++counters_.retries;
    const std::int64_t deadline_ns = send(return_delay_s_ + bytes_s(kStatusBytes + 4 * answer_bytes / 3));
    do {
      while (const auto packet = parser_.next()) {
        // Some adapters receive what they send, and return the instruction, too: it is no status packet.
        if (packet->is_status() && packet->id == id) return answer_of(*packet);
      }
    } while (receive(deadline_ns));
    ++counters_.timeouts;
  }
  return {};
}

Answer BusMaster::ping(std::uint8_t id, int tries) {
  return ask(id, 3, tries, [&](Bytes& to) { dynamixel::put_ping(to, id); });
}

Answer BusMaster::read(std::uint8_t id, std::uint16_t address, std::uint16_t count, int tries) {
  Answer answer = ask(id, count, tries, [&](Bytes& to) { dynamixel::put_read(to, id, address, count); });
  if (answer.good() && answer.data.size() != count) answer = {};  // of another question
  return answer;
}

Answer BusMaster::write(std::uint8_t id, std::uint16_t address, ByteView data, int tries) {
  return ask(id, 0, tries, [&](Bytes& to) { dynamixel::put_write(to, id, address, data); });
}

Answer BusMaster::reboot(std::uint8_t id, int tries) {
  return ask(id, 0, tries, [&](Bytes& to) { dynamixel::put_reboot(to, id); });
}

std::vector<std::pair<std::uint8_t, Answer>> BusMaster::ping_all() {
  question_.clear();
  dynamixel::put_ping(question_, dynamixel::kBroadcast);
  std::vector<std::pair<std::uint8_t, Answer>> found;
  const std::int64_t deadline_ns = send(kPingAllOf_s * dynamixel::kLargestId);
  do {
    while (const auto packet = parser_.next()) {
      if (packet->is_status()) found.emplace_back(packet->id, answer_of(*packet));
    }
  } while (receive(deadline_ns));
  return found;
}

void BusMaster::write_all(std::uint16_t address, ByteView data) {
  question_.clear();
  dynamixel::put_write(question_, dynamixel::kBroadcast, address, data);
  ++counters_.questions;
  counters_.bytes_sent += question_.size();
  port_->write(question_);
}

void BusMaster::sync_write(std::uint16_t address, std::uint16_t count, ByteView ids, ByteView data) {
  question_.clear();
  dynamixel::put_sync_write(question_, address, count, ids, data);
  ++counters_.questions;
  counters_.bytes_sent += question_.size();
  port_->write(question_);
}

std::size_t BusMaster::sync_read(std::uint16_t address, std::uint16_t count, ByteView ids, const Use& use) {
  if (ids.empty()) return 0;
  question_.clear();
  dynamixel::put_sync_read(question_, address, count, ids);
  std::size_t answered = 0;
  const std::size_t bytes = kStatusBytes + 4u * count / 3;
  std::int64_t deadline_ns = send(return_delay_s_ + bytes_s(bytes));
  const auto each_ns = static_cast<std::int64_t>(1e9 * (return_delay_s_ + bytes_s(bytes)));
  do {
    while (const auto packet = parser_.next()) {
      if (!packet->is_status() || packet->id != ids[answered]) continue;
      const Answer answer = answer_of(*packet);
      if (answer.good() && answer.data.size() != count) continue;
      use(packet->id, answer);
      if (++answered == ids.size()) return answered;
      deadline_ns += each_ns;
    }
  } while (receive(deadline_ns));
  ++counters_.timeouts;
  return answered;
}

std::size_t BusMaster::take_fast_answer(std::uint16_t count, ByteView ids, const Use& use) {
  std::size_t answered = 0;
  Answer answer;
  const auto take = [&](const dynamixel::FastAnswer& one) {
    if (answered == ids.size() || one.id != ids[answered]) return;
    answer = {true, static_cast<StatusError>(one.error & 0x7F), (one.error & dynamixel::kAlert) != 0,
              Bytes(one.data.begin(), one.data.end())};
    use(one.id, answer);
    ++answered;
  };
  // Noise before the answer may contain a header, too.
  for (auto at = whole_.begin(); answered == 0; ++at) {
    at = std::search(at, whole_.end(), dynamixel::kHeader.begin(), dynamixel::kHeader.end());
    if (at == whole_.end()) break;
    const bool is_fast = whole_.end() - at > 4 && at[4] == dynamixel::kBroadcast;
    if (is_fast) dynamixel::read_fast_answer(ByteView(at, whole_.end()), count, take);
  }
  return answered;
}

std::size_t BusMaster::fast_sync_read(std::uint16_t address, std::uint16_t count, ByteView ids, const Use& use) {
  const std::size_t most = dynamixel::fast_answer_devices(count);
  std::size_t answered = 0;
  while (answered < ids.size()) {
    const ByteView part = ids.subspan(answered, std::min(most, ids.size() - answered));
    const std::size_t more = ask_fast(address, count, part, use);
    answered += more;
    if (more < part.size()) break;  // the devices behind a silent one are silent, too
  }
  return answered;
}

std::size_t BusMaster::ask_fast(std::uint16_t address, std::uint16_t count, ByteView ids, const Use& use) {
  question_.clear();
  dynamixel::put_fast_sync_read(question_, address, count, ids);
  const std::size_t bytes = dynamixel::fast_answer_end(ids.size() - 1, count);
  const std::int64_t deadline_ns = send(return_delay_s_ * static_cast<double>(ids.size()) + bytes_s(bytes));
  whole_.clear();
  bool complete = false;
  // When as many bytes have arrived as the answer has, a damaged one need not be waited for. An adapter that receives
  // what it sends returns the instruction, too.
  const auto expected = [&] {
    const bool echo =
        whole_.size() >= question_.size() && std::equal(question_.begin(), question_.end(), whole_.begin());
    return bytes + (echo ? question_.size() : 0);
  };
  while (!complete && whole_.size() < expected() && receive(deadline_ns)) {
    whole_.insert(whole_.end(), received_.begin(), received_.end());
    while (const auto packet = parser_.next())
      complete = complete || (packet->is_status() && packet->id == dynamixel::kBroadcast);
  }
  if (!complete) ++counters_.timeouts;
  return take_fast_answer(count, ids, use);  // of an incomplete answer, the parts whose own CRC is right
}

}  // namespace constrictor::serial
