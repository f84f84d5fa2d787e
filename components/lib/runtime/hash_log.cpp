#include "runtime/hash_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <stdexcept>
#include <tuple>

#define XXH_INLINE_ALL  // so that programs that use this library need not link libxxhash
#include <xxhash.h>

#include "barrier/topic_ops.hpp"

namespace constrictor {
namespace {

constexpr char kHashLogMagic[8] = {'C', 'N', 'S', 'T', 'H', 'L', 'G', '4'};

struct HashLogHeader {
  char magic[sizeof kHashLogMagic];
  std::int64_t incomplete_from;  // tick from which on entries are missing because the disk was full; -1: none
};

struct Fixed {
  std::int64_t tick;
  std::uint64_t sequence_number;
  std::uint64_t hash;
  std::uint64_t topic;
};

HashLogHeader read_header(std::ifstream& file, const std::filesystem::path& directory) {
  HashLogHeader header{};
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header) ||
      std::memcmp(header.magic, kHashLogMagic, sizeof kHashLogMagic) != 0) {
    throw std::runtime_error((directory / "hashes.bin").string() + ": missing, or not a hash log of this release");
  }
  return header;
}

}  // namespace

HashLog::HashLog(const std::filesystem::path& directory, std::optional<std::uint64_t> length)
    : path_(directory / "hashes.bin"), hasher_(std::make_unique<MessageHasher>()) {
  std::filesystem::create_directories(directory);
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw std::runtime_error(path_.string() + ": " + std::strerror(errno));
  if (!length) {
    restart();
    return;
  }
  const auto found = static_cast<std::uint64_t>(::lseek(descriptor_, 0, SEEK_END));
  if (found < *length) {
    ::close(descriptor_);
    throw std::runtime_error(fmt::format("{}: found {} bytes, but at the checkpoint it had {} (was it cut or removed?)",
                                         path_.string(), found, *length));
  }
  full_ = full_disk_at(directory).has_value();
  length_ = *length;
  static_cast<void>(!::ftruncate(descriptor_, static_cast<off_t>(length_)));  // entries beyond it are written again
}

HashLog::~HashLog() {
  flush();
  ::close(descriptor_);
}

void HashLog::write_header(std::int64_t incomplete_from) const {
  HashLogHeader header{{}, incomplete_from};
  std::memcpy(header.magic, kHashLogMagic, sizeof kHashLogMagic);
  if (::pwrite(descriptor_, &header, sizeof header, 0) != sizeof header)
    throw std::runtime_error(path_.string() + ": " + std::strerror(errno));
}

void HashLog::restart() {
  buffer_.clear();
  full_ = false;
  if (::ftruncate(descriptor_, 0) != 0) throw std::runtime_error(path_.string() + ": " + std::strerror(errno));
  write_header(-1);
  length_ = sizeof(HashLogHeader);
}

std::string HashLog::flush() {
  if (full_) buffer_.clear();
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written =
        ::pwrite(descriptor_, buffer_.data() + done, buffer_.size() - done, static_cast<off_t>(length_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const std::string reason = std::strerror(written < 0 ? errno : ENOSPC);
      full_ = true;
      buffer_.clear();
      write_header(newest_tick_);  // these bytes have their place on the disk already
      return fmt::format("{}: {}", path_.string(), reason);
    }
    done += static_cast<std::size_t>(written);
  }
  length_ += buffer_.size();
  buffer_.clear();
  return {};
}

std::optional<std::int64_t> HashLog::full_disk_at(const std::filesystem::path& directory) {
  std::ifstream file(directory / "hashes.bin", std::ios::binary);
  const HashLogHeader header = read_header(file, directory);
  return header.incomplete_from < 0 ? std::nullopt : std::optional(header.incomplete_from);
}

void HashLog::add(const TopicInfo& topic, const Sample& sample) {
  message_.clear();
  topic_ops(topic.id).append_bytes(sample.message.get(), message_);
  add(topic.id, message_);
}

MessageHasher::MessageHasher() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
}

MessageHasher::~MessageHasher() { XXH3_freeState(static_cast<XXH3_state_t*>(state_)); }

std::optional<HashLog::Entry> MessageHasher::entry_of(std::uint8_t topic, const std::string& bytes) {
  const auto message = std::as_bytes(std::span(bytes));
  const auto header_at = topic_ops(topic).header_at(message);
  if (!header_at) return {};
  const auto header = parse_header(message.subspan(*header_at).first<kHeaderSize>());
  constexpr std::array<std::byte, sizeof(std::uint16_t)> kNoRobot{};
  auto* state = static_cast<XXH3_state_t*>(state_);
  const auto update = [state](std::span<const std::byte> part) {
    static_cast<void>(XXH3_64bits_update(state, part.data(), part.size()));
  };
  static_cast<void>(XXH3_64bits_reset(state));
  update(kNoRobot);
  update(message.first(*header_at).subspan(kNoRobot.size()));
  update(header_bytes(neutral_header(header)));
  update(message.subspan(*header_at + kHeaderSize));
  return HashLog::Entry{header.tick, header.sequence_number, topic, XXH3_64bits_digest(state), {}};
}

void HashLog::add(std::uint8_t topic, const std::string& bytes) {
  const auto entry = hasher_->entry_of(topic, bytes);
  if (!entry) return;
  const Fixed fixed{entry->tick, entry->sequence_number, entry->hash, topic};
  newest_tick_ = std::max(newest_tick_, fixed.tick);
  buffer_.append(reinterpret_cast<const char*>(&fixed), sizeof(fixed));
}

std::vector<HashLog::Entry> HashLog::read(const std::filesystem::path& directory) {
  std::ifstream file(directory / "hashes.bin", std::ios::binary);
  read_header(file, directory);
  std::vector<Entry> entries;
  Fixed fixed{};
  while (file.read(reinterpret_cast<char*>(&fixed), sizeof(fixed))) {
    if (fixed.topic >= topics::kCount) throw std::runtime_error((directory / "hashes.bin").string() + ": damaged");
    entries.push_back(
        {fixed.tick, fixed.sequence_number, static_cast<std::uint8_t>(fixed.topic), fixed.hash, std::string()});
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.tick, a.topic, a.sequence_number) < std::tie(b.tick, b.topic, b.sequence_number);
  });
  return entries;
}

}  // namespace constrictor
