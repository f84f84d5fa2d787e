#include "runtime/checkpoint_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#define XXH_INLINE_ALL  // so that programs that use this library need not link libxxhash
#include <xxhash.h>

namespace constrictor {
namespace {

constexpr char kCheckpointMagic[8] = {'C', 'N', 'S', 'T', 'C', 'K', 'P', '1'};
constexpr std::size_t kPage = 4096;
constexpr std::size_t kFirstPart = 3 * kPage;  // after the header and the two slots, each on a page of its own
constexpr std::size_t kFirstSize = 256 * kPage;
constexpr std::size_t kLongestBoot = 63;  // [byte] of the name of a boot
constexpr std::size_t kUnit = 64;         // [byte] parts begin at multiples of it

std::uint64_t checksum_of(const void* bytes, std::size_t size) { return XXH3_64bits(bytes, size); }

std::uint64_t rounded(std::uint64_t size) { return (size + kUnit - 1) / kUnit * kUnit; }

std::string boot_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(file, id);
  return id.substr(0, kLongestBoot);
}

struct CheckpointHeader {
  char magic[sizeof kCheckpointMagic];
  char boot[kLongestBoot + 1];  // the boot of the computer in which the file was made

  /// Bytes that are right already stay as they are: a process that is killed here leaves a file of this boot.
  void note_boot() {
    std::string id = boot_id();
    id.resize(sizeof boot);
    std::memcpy(boot, id.data(), sizeof boot);
  }
};

std::runtime_error failure(const std::filesystem::path& path, const std::string& what) {
  return std::runtime_error(fmt::format("{}: {}", path.string(), what));
}

}  // namespace

struct CheckpointFile::Slot {
  std::uint64_t number;
  Part table;  // the list of the blobs' parts, and then the head
  std::uint64_t blobs;
  std::uint64_t checksum;  // of all above

  [[nodiscard]] std::uint64_t own_checksum() const { return checksum_of(this, offsetof(Slot, checksum)); }
};

CheckpointFile::CheckpointFile(std::filesystem::path path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw failure(path_, std::strerror(errno));
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
      throw CheckpointInUse(
          failure(path_, "another process of the plant has this file open: is the run still going on?").what());
    const off_t found = ::lseek(descriptor_, 0, SEEK_END);
    size_ = static_cast<std::size_t>(found);
    // A process that was killed while it made the file may have left it without content.
    char magic[sizeof kCheckpointMagic] = {};
    const bool fresh = ::pread(descriptor_, magic, sizeof magic, 0) < 0 ||
                       std::all_of(magic, std::end(magic), [](char c) { return c == 0; });
    if (!fresh && size_ < kFirstSize) throw failure(path_, "found a file that is too short for a checkpoint");
    grow(fresh ? kFirstSize : size_);
    auto& header = *reinterpret_cast<CheckpointHeader*>(data_);
    if (fresh) {
      header.note_boot();
      std::atomic_signal_fence(std::memory_order_seq_cst);
      std::memcpy(header.magic, kCheckpointMagic, sizeof kCheckpointMagic);
    } else if (std::memcmp(header.magic, kCheckpointMagic, sizeof kCheckpointMagic) != 0) {
      throw failure(path_, "found a file that is no checkpoint of this release");
    }
  } catch (...) {
    if (data_) ::munmap(data_, size_);
    ::close(descriptor_);
    throw;
  }
}

CheckpointFile::~CheckpointFile() {
  ::munmap(data_, size_);
  ::close(descriptor_);
}

bool CheckpointFile::of_this_boot() const {
  const auto& header = *reinterpret_cast<const CheckpointHeader*>(data_);
  return std::string(header.boot, ::strnlen(header.boot, sizeof header.boot)) == boot_id();
}

CheckpointFile::Slot& CheckpointFile::slot(std::uint64_t number) const {
  return *reinterpret_cast<Slot*>(data_ + (number % 2 + 1) * kPage);
}

void CheckpointFile::grow(std::size_t least) {
  std::size_t wanted = std::max(size_, kFirstSize);
  while (wanted < least) wanted *= 2;
  // Without blocks on the disk, a store into the mapped file would end the process (SIGBUS) when the disk is full.
  if (const int error = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(wanted)); error != 0)
    throw failure(path_, fmt::format("cannot grow to {} bytes: {}", wanted, std::strerror(error)));
  void* mapped = data_ ? ::mremap(data_, size_, wanted, MREMAP_MAYMOVE)
                       : ::mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (mapped == MAP_FAILED) throw failure(path_, std::strerror(errno));
  const std::size_t before = data_ ? size_ : kFirstPart;
  data_ = static_cast<char*>(mapped);
  size_ = wanted;
  if (size_ > before) add_free(before, size_ - before);
}

void CheckpointFile::add_free(std::uint64_t offset, std::uint64_t size) {
  auto next = std::ranges::lower_bound(free_, offset, {}, &Free::offset);
  if (next != free_.end() && offset + size == next->offset) {
    size += next->size;
    next = free_.erase(next);
  }
  if (next != free_.begin()) {
    const auto previous = std::prev(next);
    if (previous->offset + previous->size == offset) {
      previous->size += size;
      return;
    }
  }
  free_.insert(next, {offset, size});
}

std::uint64_t CheckpointFile::allocate(std::size_t size) {
  const std::uint64_t wanted = rounded(std::max<std::size_t>(size, 1));
  for (;;) {
    for (auto at = free_.begin(); at != free_.end(); ++at) {
      if (at->size < wanted) continue;
      const std::uint64_t offset = at->offset;
      if (at->size == wanted) free_.erase(at);
      else *at = {offset + wanted, at->size - wanted};
      return offset;
    }
    grow(size_ + wanted);
  }
}

void CheckpointFile::release(const Part& part) {
  if (part.offset != 0) add_free(part.offset, rounded(std::max<std::uint64_t>(part.size, 1)));
}

void CheckpointFile::reserve(const Part& part) {
  const std::uint64_t end = part.offset + rounded(std::max<std::uint64_t>(part.size, 1));
  const auto at = std::prev(std::ranges::upper_bound(free_, part.offset, {}, &Free::offset));
  const auto [offset, length] = *at;
  free_.erase(at);
  if (offset < part.offset) add_free(offset, part.offset - offset);
  if (offset + length > end) add_free(end, offset + length - end);
}

CheckpointFile::Stored& CheckpointFile::store(const Blob& blob, std::size_t sorted) {
  const auto end = stored_.begin() + static_cast<std::ptrdiff_t>(sorted);
  const auto found = std::ranges::lower_bound(stored_.begin(), end, blob, {}, &Stored::blob);
  if (found != end && found->blob == blob) return *found;
  return stored_.emplace_back(Stored{blob, put(blob->data(), blob->size()), 0});
}

CheckpointFile::Part CheckpointFile::put(const char* bytes, std::size_t size) {
  const std::uint64_t offset = allocate(size);
  std::memcpy(data_ + offset, bytes, size);
  return {offset, size, checksum_of(bytes, size)};
}

void CheckpointFile::write(const Checkpoint& checkpoint) {
  ++number_;
  table_.clear();
  const std::size_t sorted = stored_.size();
  for (const Blob& blob : checkpoint.blobs) {
    Stored& stored = store(blob, sorted);
    stored.last_used = number_;
    table_.append(reinterpret_cast<const char*>(&stored.part), sizeof stored.part);
  }
  std::ranges::sort(stored_, {}, &Stored::blob);
  table_ += checkpoint.head;
  const Part table = put(table_.data(), table_.size());
  Slot& next = slot(number_);
  // The order of these stores matters only if the process is killed between two of them. What the kernel then keeps is
  // in program order; only the compiler must not change it.
  next.checksum = ~next.own_checksum();
  std::atomic_signal_fence(std::memory_order_seq_cst);
  next.number = number_;
  next.table = table;
  next.blobs = checkpoint.blobs.size();
  std::atomic_signal_fence(std::memory_order_seq_cst);
  next.checksum = next.own_checksum();
  // Memory that only the checkpoint before the previous one used is free now.
  release(std::exchange(table_of_last_but_one_, std::exchange(table_of_last_, table)));
  std::erase_if(stored_, [this](const Stored& stored) {
    if (stored.last_used + 1 >= number_) return false;
    release(stored.part);
    return true;
  });
}

void CheckpointFile::clear() {
  std::memset(data_ + kPage, 0, 2 * kPage);
  reinterpret_cast<CheckpointHeader*>(data_)->note_boot();
  number_ = 0;
  stored_.clear();
  table_of_last_ = table_of_last_but_one_ = {};
  free_ = {{kFirstPart, size_ - kFirstPart}};
}

bool CheckpointFile::holds(const Part& part) const {
  return part.offset >= kFirstPart && part.offset % kUnit == 0 && part.offset < size_ &&
         part.size <= size_ - part.offset && checksum_of(data_ + part.offset, part.size) == part.checksum;
}

std::optional<Checkpoint> CheckpointFile::read_slot(const Slot& slot, std::map<std::size_t, Part>& parts) const {
  if (slot.number == 0 || slot.checksum != slot.own_checksum() || !holds(slot.table)) return {};
  if (slot.blobs > slot.table.size / sizeof(Part)) return {};
  Checkpoint checkpoint;
  const char* table = data_ + slot.table.offset;
  for (std::size_t i = 0; i < slot.blobs; ++i) {
    Part part;
    std::memcpy(&part, table + i * sizeof part, sizeof part);
    if (!holds(part)) return {};
    parts.emplace(i, part);
    checkpoint.blobs.push_back(std::make_shared<const std::string>(data_ + part.offset, part.size));
  }
  const std::size_t list = slot.blobs * sizeof(Part);
  checkpoint.head.assign(table + list, slot.table.size - list);
  return checkpoint;
}

std::optional<Checkpoint> CheckpointFile::read() {
  if (number_ > 0) throw std::logic_error("a checkpoint file is read before it is written");
  static constexpr Slot kEmpty{};
  const auto empty = [](const Slot& slot) { return std::memcmp(&slot, &kEmpty, sizeof slot) == 0; };
  if (empty(slot(0)) && empty(slot(1))) return {};
  const std::uint64_t newer = slot(0).number > slot(1).number ? 0 : 1;
  for (const std::uint64_t which : {newer, 1 - newer}) {
    std::map<std::size_t, Part> parts;
    auto checkpoint = read_slot(slot(which), parts);
    if (!checkpoint) {
      one_slot_damaged_ |= !empty(slot(which));
      continue;
    }
    // Nothing of this checkpoint may be overwritten before the next but one.
    number_ = slot(which).number;
    reserve(slot(which).table);
    table_of_last_ = slot(which).table;
    for (const auto& [i, part] : parts) {
      reserve(part);
      stored_.push_back({checkpoint->blobs[i], part, number_});
    }
    std::ranges::sort(stored_, {}, &Stored::blob);
    return checkpoint;
  }
  throw failure(path_, "both checkpoints in it are damaged; the run cannot be continued from this file");
}

void CheckpointFile::store_copy(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  std::filesystem::path beside = path;
  beside += ".part";
  std::filesystem::remove(beside);
  {
    CheckpointFile file(beside);
    file.write(checkpoint);
    if (::fsync(file.descriptor_) != 0) throw failure(beside, std::strerror(errno));
  }
  std::filesystem::rename(beside, path);
  const int folder = ::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0 || ::fsync(folder) != 0) {
    const int error = errno;
    if (folder >= 0) ::close(folder);
    throw failure(path.parent_path(), std::strerror(error));
  }
  ::close(folder);
}

std::optional<Checkpoint> CheckpointFile::read_copy(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return {};
  return CheckpointFile(path).read();
}

}  // namespace constrictor
