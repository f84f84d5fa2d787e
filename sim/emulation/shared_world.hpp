// The newest state of an emulated world, in a file that several programs map into their memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "constrictor/messages.hpp"
#include "sim/world/world.hpp"

namespace constrictor::emulation {

struct SharedBlock;  ///< the content of the file

/// A mapped file. Move-only.
class SharedMapping {
 public:
  SharedMapping() = default;
  SharedMapping(int descriptor, bool writable);  ///< throws std::system_error
  SharedMapping(SharedMapping&& other) noexcept;
  SharedMapping& operator=(SharedMapping&& other) noexcept;
  ~SharedMapping();
  [[nodiscard]] SharedBlock* block() const { return block_; }

 private:
  SharedBlock* block_ = nullptr;
};

/// The poses of the bodies at one time.
struct WorldSnapshot {
  msg::WorldState world{};   ///< poses; the other fields are empty
  std::int64_t time_ns = 0;  ///< of the world
};

/// Writes the file. It never waits for readers: they notice that they have read while it wrote, and read again.
class SharedWorldWriter {
 public:
  /// Replaces the file. Throws std::system_error.
  explicit SharedWorldWriter(const std::filesystem::path& file);
  ~SharedWorldWriter();
  SharedWorldWriter(const SharedWorldWriter&) = delete;
  SharedWorldWriter& operator=(const SharedWorldWriter&) = delete;

  void write(const World& world);

 private:
  std::filesystem::path file_;
  SharedMapping mapping_;
};

/// Reads the file, as soon as it exists.
class SharedWorldReader {
 public:
  /// `modules`, `objects`: how many bodies the world must have.
  SharedWorldReader(std::filesystem::path file, std::size_t modules, std::size_t objects);

  /// The newest state; empty as long as there is none. Throws std::runtime_error if the file is of another program or
  /// of a world with other bodies.
  [[nodiscard]] std::optional<WorldSnapshot> read();

 private:
  std::filesystem::path file_;
  std::size_t modules_, objects_;
  SharedMapping mapping_;
};

}  // namespace constrictor::emulation
