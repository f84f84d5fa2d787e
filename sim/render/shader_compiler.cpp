#include "sim/render/shader_compiler.hpp"

#include <fcntl.h>
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

namespace constrictor {
namespace {

/// Releases the pages of LLVM's file that no one can have written: neither variables nor relocated tables.
int release_pages(dl_phdr_info* library, std::size_t, void*) {
  if (!std::filesystem::path(library->dlpi_name).filename().string().starts_with("libLLVM")) return 0;
  const std::span segments(library->dlpi_phdr, library->dlpi_phnum);
  for (const auto& segment : segments) {
    if (segment.p_type != PT_DYNAMIC) continue;
    // A library with relocations in its code has pages that differ from its file.
    // The loader gives addresses as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* entry = reinterpret_cast<const ElfW(Dyn)*>(library->dlpi_addr + segment.p_vaddr);
    for (; entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_TEXTREL) return 0;
  }
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  for (const auto& segment : segments) {
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t end = (library->dlpi_addr + segment.p_vaddr + segment.p_memsz + page - 1) / page * page;
    // A failure costs only memory. NOLINTNEXTLINE(performance-no-int-to-ptr)
    (void)::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
  }
  return 0;
}

/// Bytes of files, LLVM's among them, that this process has in memory (proc(5), statm); 0 if the kernel does not say
/// so.
std::int64_t file_bytes() {
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  std::array<char, 128> text{};
  const ssize_t length = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  std::int64_t pages = 0;
  if (length <= 0 || std::sscanf(text.data(), "%*d %*d %" SCNd64, &pages) != 1) return 0;
  return pages * ::sysconf(_SC_PAGESIZE);
}

}  // namespace

void release_shader_compiler() {
  ::dl_iterate_phdr(release_pages, nullptr);
  (void)::malloc_trim(0);
}

void ShaderCompilerMemory::after_image() {
  constexpr std::int64_t kMany = 2 << 20;  // another shader brings 20 MiB and more
  const std::int64_t now = file_bytes();
  if (file_bytes_ >= 0 && now <= file_bytes_ + kMany) {
    file_bytes_ = std::min(file_bytes_, now);
    return;
  }
  release_shader_compiler();
  file_bytes_ = file_bytes();
}

}  // namespace constrictor
