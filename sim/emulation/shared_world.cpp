#include "sim/emulation/shared_world.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace constrictor::emulation {
namespace {

constexpr std::uint64_t kMagic = 0x31646c726f77'6e63;  // "cnworld1"
constexpr std::size_t kMostBodies = msg::kMaxModules + msg::kMaxSceneObjects;
constexpr int kTries = 1000;

std::system_error file_error(const std::filesystem::path& file) {
  return {errno, std::generic_category(), file.string()};
}

}  // namespace

/// A sequence lock (H.-J. Boehm, "Can seqlocks get along with programming language memory models?", 2012): the number
/// is odd while the writer writes. All fields are atomic, so that a torn read is wrong, but defined.
struct SharedBlock {
  using Field = std::atomic<double>;
  std::atomic<std::uint64_t> magic;
  std::atomic<std::uint64_t> sequence;
  std::atomic<std::int64_t> time_ns;
  std::atomic<std::uint64_t> modules, objects;
  std::array<std::array<Field, 7>, kMostBodies> poses;  ///< x y z, w x y z
};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::uint64_t>::is_always_lock_free);

SharedMapping::SharedMapping(int descriptor, bool writable) {
  void* memory =
      ::mmap(nullptr, sizeof(SharedBlock), writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap of the emulated world");
  block_ = static_cast<SharedBlock*>(memory);
}
SharedMapping::SharedMapping(SharedMapping&& other) noexcept : block_(std::exchange(other.block_, nullptr)) {}
SharedMapping& SharedMapping::operator=(SharedMapping&& other) noexcept {
  std::swap(block_, other.block_);
  return *this;
}
SharedMapping::~SharedMapping() {
  if (block_ != nullptr) ::munmap(block_, sizeof(SharedBlock));
}

SharedWorldWriter::SharedWorldWriter(const std::filesystem::path& file) : file_(file) {
  // A new file under the old name: readers of an earlier world keep theirs, and never see a truncated one.
  const std::filesystem::path next = file.string() + ".new";
  const int descriptor = ::open(next.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) throw file_error(next);
  if (::ftruncate(descriptor, sizeof(SharedBlock)) != 0) {
    const auto error = file_error(next);
    ::close(descriptor);
    throw error;
  }
  mapping_ = SharedMapping(descriptor, true);
  ::close(descriptor);
  std::filesystem::rename(next, file);
}

SharedWorldWriter::~SharedWorldWriter() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void SharedWorldWriter::write(const World& world) {
  SharedBlock& block = *mapping_.block();
  const std::uint64_t sequence = block.sequence.load(std::memory_order_relaxed);
  block.sequence.store(sequence + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  std::size_t body = 0;
  const auto put = [&](const Eigen::Isometry3d& X) {
    const Eigen::Quaterniond q(X.linear());
    const double values[7] = {
        X.translation().x(), X.translation().y(), X.translation().z(), q.w(), q.x(), q.y(), q.z()};
    for (std::size_t i = 0; i < 7; ++i) block.poses[body][i].store(values[i], std::memory_order_relaxed);
    ++body;
  };
  for (std::size_t i = 0; i < world.module_count(); ++i) put(world.module_pose(i));
  for (std::size_t i = 0; i < world.object_count(); ++i) put(world.object_pose(i));
  block.modules.store(world.module_count(), std::memory_order_relaxed);
  block.objects.store(world.object_count(), std::memory_order_relaxed);
  block.time_ns.store(std::llround(world.time_s() * 1e9), std::memory_order_relaxed);
  block.magic.store(kMagic, std::memory_order_relaxed);
  block.sequence.store(sequence + 2, std::memory_order_release);
}

SharedWorldReader::SharedWorldReader(std::filesystem::path file, std::size_t modules, std::size_t objects)
    : file_(std::move(file)), modules_(modules), objects_(objects) {}

std::optional<WorldSnapshot> SharedWorldReader::read() {
  if (mapping_.block() == nullptr) {
    const int descriptor = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return {};
    struct stat status {};
    const bool whole = ::fstat(descriptor, &status) == 0 && status.st_size == static_cast<off_t>(sizeof(SharedBlock));
    if (whole) mapping_ = SharedMapping(descriptor, false);
    ::close(descriptor);
    if (!whole)
      throw std::runtime_error(fmt::format("{}: found {} bytes, accepted the world of a servo_emulator of this release",
                                           file_.string(), status.st_size));
  }
  const SharedBlock& block = *mapping_.block();
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const std::uint64_t before = block.sequence.load(std::memory_order_acquire);
    if (before == 0) return {};  // nothing is written yet
    if (before % 2 != 0) continue;
    WorldSnapshot found;
    const std::uint64_t magic = block.magic.load(std::memory_order_relaxed);
    const std::uint64_t modules = block.modules.load(std::memory_order_relaxed);
    const std::uint64_t objects = block.objects.load(std::memory_order_relaxed);
    found.time_ns = block.time_ns.load(std::memory_order_relaxed);
    std::size_t body = 0;
    const auto get = [&] {
      double v[7];
      for (std::size_t i = 0; i < 7; ++i) v[i] = block.poses[body][i].load(std::memory_order_relaxed);
      ++body;
      return msg::Pose3{{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
    };
    for (std::size_t i = 0; i < modules_; ++i) found.world.module_poses[i] = get();
    for (std::size_t i = 0; i < objects_; ++i) found.world.object_poses[i] = get();
    std::atomic_thread_fence(std::memory_order_acquire);
    if (block.sequence.load(std::memory_order_relaxed) != before) continue;
    if (magic != kMagic || modules != modules_ || objects != objects_)
      throw std::runtime_error(
          fmt::format("{}: found a world with {} modules and {} objects, accepted {} and {}: give "
                      "both emulators the same robot, scenario and seed",
                      file_.string(), modules, objects, modules_, objects_));
    found.world.module_count = static_cast<std::uint16_t>(modules);
    found.world.object_count = static_cast<std::uint16_t>(objects);
    return found;
  }
  return {};
}

}  // namespace constrictor::emulation
