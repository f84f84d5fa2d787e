#include "sim/render/shader_compiler.hpp"

#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace constrictor {
namespace {

/// Whole pages of the file of LLVM that no one can have written: neither variables nor relocated tables.
using Pages = std::vector<std::span<unsigned char>>;

int add_pages(dl_phdr_info* library, std::size_t, void* result) {
  if (!std::filesystem::path(library->dlpi_name).filename().string().starts_with("libLLVM")) return 0;
  const std::span segments(library->dlpi_phdr, library->dlpi_phnum);
  for (const auto& segment : segments) {
    if (segment.p_type == PT_DYNAMIC) {
      // A library with relocations in its code has pages that differ from its file.
      const auto* entry = reinterpret_cast<const ElfW(Dyn)*>(library->dlpi_addr + segment.p_vaddr);
      for (; entry->d_tag != DT_NULL; ++entry)
        if (entry->d_tag == DT_TEXTREL) return 0;
    }
  }
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  for (const auto& segment : segments) {
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t end = (library->dlpi_addr + segment.p_vaddr + segment.p_memsz + page - 1) / page * page;
    static_cast<Pages*>(result)->emplace_back(reinterpret_cast<unsigned char*>(begin), end - begin);
  }
  return 0;
}

}  // namespace

void release_shader_compiler() {
  Pages pages;
  ::dl_iterate_phdr(add_pages, &pages);
  // A failure costs only memory.
  for (const auto& range : pages) (void)::madvise(range.data(), range.size(), MADV_DONTNEED);
  (void)::malloc_trim(0);
}

}  // namespace constrictor
