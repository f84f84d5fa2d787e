#include "runtime/hash_log.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <tuple>

#include "barrier/topic_ops.hpp"

namespace constrictor {
namespace {

constexpr char kMagic[8] = {'C', 'N', 'S', 'T', 'H', 'L', 'G', '1'};
constexpr std::size_t kLargest = 20'000;  // [byte] messages above this (images) are never recorded whole

struct Fixed {
  std::int64_t tick;
  std::uint64_t sequence_number;
  std::uint64_t hash;
  std::uint32_t size;
  std::uint32_t topic;
};

}  // namespace

HashLog::HashLog(const std::filesystem::path& directory, bool record)
    : path_(directory / "hashes.bin"), record_(record) {
  std::filesystem::create_directories(directory);
  restart();
  if (!file_) throw std::runtime_error("cannot write " + path_.string());
}

void HashLog::restart() {
  file_.close();
  file_.open(path_, std::ios::binary | std::ios::trunc);
  file_.write(kMagic, sizeof(kMagic));
}

void HashLog::add(const TopicInfo& topic, const Sample& sample) {
  std::string bytes;
  topic_ops(topic.id).append_bytes(sample.message.get(), bytes);
  add(topic.id, bytes);
}

void HashLog::add(std::uint8_t topic, const std::string& bytes) {
  const auto message = std::as_bytes(std::span(bytes));
  const auto header_at = topic_ops(topic).header_at(message);
  if (!header_at) return;
  const auto header = parse_header(message.subspan(*header_at).first<kHeaderSize>());
  // The hash is that of the message with a neutral header and robot id 0.
  constexpr std::array<std::byte, sizeof(std::uint16_t)> kNoRobot{};
  const HeaderBytes neutral = header_bytes(neutral_header(header));
  const std::array<std::span<const std::byte>, 4> pieces{kNoRobot, message.first(*header_at).subspan(kNoRobot.size()),
                                                         neutral, message.subspan(*header_at + kHeaderSize)};
  for (const auto& piece : pieces) hash_.update(piece);
  const auto digest = hash_.finish();
  Fixed fixed{header.tick, header.sequence_number, 0, 0, topic};
  std::memcpy(&fixed.hash, digest.data(), sizeof(fixed.hash));
  const bool whole = record_ && bytes.size() <= kLargest;
  if (whole) fixed.size = static_cast<std::uint32_t>(bytes.size());
  file_.write(reinterpret_cast<const char*>(&fixed), sizeof(fixed));
  if (!whole) return;
  for (const auto& piece : pieces)
    file_.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
}

std::vector<HashLog::Entry> HashLog::read(const std::filesystem::path& directory) {
  std::ifstream file(directory / "hashes.bin", std::ios::binary);
  char magic[sizeof(kMagic)];
  if (!file.read(magic, sizeof(magic)) || std::memcmp(magic, kMagic, sizeof(magic)) != 0) {
    throw std::runtime_error((directory / "hashes.bin").string() + ": missing, or not a hash log");
  }
  std::vector<Entry> entries;
  Fixed fixed{};
  while (file.read(reinterpret_cast<char*>(&fixed), sizeof(fixed))) {
    if (fixed.topic >= topics::kCount || fixed.size > kLargest) {
      throw std::runtime_error((directory / "hashes.bin").string() + ": damaged");
    }
    Entry entry{fixed.tick, fixed.sequence_number, static_cast<std::uint8_t>(fixed.topic), fixed.hash,
                std::string(fixed.size, '\0')};
    if (!file.read(entry.bytes.data(), fixed.size)) break;
    entries.push_back(std::move(entry));
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.tick, a.topic, a.sequence_number) < std::tie(b.tick, b.topic, b.sequence_number);
  });
  return entries;
}

}  // namespace constrictor
