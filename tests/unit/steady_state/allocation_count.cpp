#include "allocation_count.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace constrictor::testing {
namespace {

thread_local std::uint64_t t_all = 0;
thread_local std::uint64_t t_own = 0;

}  // namespace

AllocationCount::AllocationCount() : all_before_(t_all), own_before_(t_own) {}
std::uint64_t AllocationCount::all() const { return t_all - all_before_; }
std::uint64_t AllocationCount::own() const { return t_own - own_before_; }

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

bool AllocationCount::works() { return false; }

}  // namespace constrictor::testing

#else

bool AllocationCount::works() { return true; }

}  // namespace constrictor::testing

// NOLINTBEGIN(bugprone-reserved-identifier): names of the linker and of the C library
extern "C" {
extern const char __executable_start;  // the code of the program lies between these two
extern const char etext;
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
}

namespace {

/// `caller`: an address in the function that has asked for memory.
void note(const void* caller) {
  using namespace constrictor::testing;
  ++t_all;
  if (caller >= static_cast<const void*>(&__executable_start) && caller < static_cast<const void*>(&etext)) ++t_own;
}

void* allocate(std::size_t size, const void* caller) {
  note(caller);
  return __libc_malloc(size);
}

void* allocate_or_throw(std::size_t size, const void* caller) {
  void* block = allocate(size, caller);
  if (!block) throw std::bad_alloc();
  return block;
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) noexcept { return allocate(size, __builtin_return_address(0)); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  note(__builtin_return_address(0));
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  note(__builtin_return_address(0));
  return __libc_realloc(block, size);
}
}
// NOLINTEND(bugprone-reserved-identifier)

void* operator new(std::size_t size) { return allocate_or_throw(size, __builtin_return_address(0)); }
void* operator new[](std::size_t size) { return allocate_or_throw(size, __builtin_return_address(0)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, __builtin_return_address(0));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, __builtin_return_address(0));
}

#endif
