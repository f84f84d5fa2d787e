// Counts allocations of memory. Its source replaces malloc() and operator new of the program that contains it.
#pragma once

#include <cstdint>

namespace constrictor::testing {

/// Counts what the present thread allocates from the construction on. Blocks with a greater alignment than usual are
/// not counted.
class AllocationCount {
 public:
  /// False in a program with sanitizers, which replace malloc() themselves: there, all counts are 0.
  static bool works();

  AllocationCount();
  /// All blocks, and those that the code of this program asked for: without what shared libraries, such as OpenCV,
  /// allocate for themselves.
  [[nodiscard]] std::uint64_t all() const;
  [[nodiscard]] std::uint64_t own() const;

 private:
  std::uint64_t all_before_, own_before_;
};

}  // namespace constrictor::testing
