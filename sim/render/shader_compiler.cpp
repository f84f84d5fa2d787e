#include "sim/render/shader_compiler.hpp"

#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
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

}  // namespace

void release_shader_compiler() {
  ::dl_iterate_phdr(release_pages, nullptr);
  (void)::malloc_trim(0);
}

void ShaderCompilerMemory::after_image() {
  constexpr long kManyFaults = 100;  // an image without a new shader has none or a few, one with a new shader hundreds
  const auto faults = [] {
    rusage usage{};
    ::getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_minflt + usage.ru_majflt;
  };
  const long now = faults();
  if (now - page_faults_ > kManyFaults) release_shader_compiler();
  page_faults_ = now;
}

}  // namespace constrictor
