#include "runtime/loaded_libraries.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "constrictor/hex.hpp"

namespace constrictor {
namespace {

struct Known {
  const char* file;  ///< beginning of the file's name
  const char* name;
};
constexpr std::array kKnown{Known{"libode.so", "ode"},
                            Known{"libopencv_core.so", "opencv_core"},
                            Known{"libopencv_imgproc.so", "opencv_imgproc"},
                            Known{"libOSMesa.so", "mesa"},
                            Known{"libLLVM", "llvm"},
                            Known{"libm.so", "libm"},
                            Known{"libstdc++.so", "libstdc++"},
                            Known{"libddsc.so", "cyclonedds"}};

constexpr std::size_t kShownBytes = 6;  // of a build id, which has 20 bytes

std::string build_id(const dl_phdr_info& library) {
  for (int i = 0; i < library.dlpi_phnum; ++i) {
    const auto& segment = library.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
    const auto* at = reinterpret_cast<const unsigned char*>(library.dlpi_addr + segment.p_vaddr);
    const auto* end = at + segment.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof(note));
      const auto padded = [](std::size_t size) { return (size + 3) & ~std::size_t{3}; };
      const unsigned char* id = at + sizeof(note) + padded(note.n_namesz);
      if (note.n_type == NT_GNU_BUILD_ID && id + note.n_descsz <= end)
        return hex({id, std::min<std::size_t>(note.n_descsz, kShownBytes)});
      at = id + padded(note.n_descsz);
    }
  }
  return "unknown";
}

int visit(dl_phdr_info* library, std::size_t, void* result) {
  auto& found = *static_cast<std::vector<std::pair<std::string, std::string>>*>(result);
  const std::filesystem::path path = library->dlpi_name;
  const std::string file = path.filename().string();
  for (const auto& known : kKnown) {
    if (!file.starts_with(known.file)) continue;
    std::error_code ignored;
    const auto real = std::filesystem::canonical(path, ignored);  // the name of the link is the same in all releases
    found.emplace_back(known.name,
                       fmt::format("{} {}", real.empty() ? file : real.filename().string(), build_id(*library)));
  }
  return 0;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> loaded_libraries() {
  std::vector<std::pair<std::string, std::string>> found;
  ::dl_iterate_phdr(visit, &found);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace constrictor
