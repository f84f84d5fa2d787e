#include "sim/report/raw_images.hpp"

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "sim/report/files.hpp"
#include "sim/report/moments.hpp"

namespace constrictor::report {
namespace {

struct RawHeader {
  std::int64_t exposure_tick = 0;
  std::uint16_t width = 0, height = 0;
  std::uint32_t unused = 0;
};

std::filesystem::path raw_file(const std::filesystem::path& folder, std::size_t slot) {
  return folder / MomentFiles::kFolder / (RawImages::kName + std::to_string(slot) + ".bin");
}

/// Throws NotWritten.
void overwrite(const std::filesystem::path& path, const msg::CameraImage& image) {
  std::error_code ignored;  // then the file cannot be opened either
  std::filesystem::create_directories(path.parent_path(), ignored);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) throw NotWritten(path, std::strerror(errno));
  RawHeader header{image.exposure_tick, image.width, image.height};
  const iovec parts[] = {{&header, sizeof header}, {image.data._buffer, image.data._length}};
  const ssize_t written = ::writev(descriptor, parts, 2);
  const int error = written < 0 ? errno : ENOSPC;
  ::close(descriptor);
  if (written != static_cast<ssize_t>(sizeof header + image.data._length)) throw NotWritten(path, std::strerror(error));
}

}  // namespace

void RawImages::keep(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost) {
  if (disk_is_full_ || std::find(exposures_.begin(), exposures_.end(), image.exposure_tick) != exposures_.end()) return;
  // A free file counts as the oldest one.
  const auto age = [&](std::int64_t exposure) { return std::pair(exposure == processed_tick_, exposure); };
  const auto oldest = std::min_element(exposures_.begin(), exposures_.end(), [&](std::int64_t one, std::int64_t other) {
    return one == kFree || other == kFree ? one < other : age(one) < age(other);
  });
  const auto slot = static_cast<std::size_t>(oldest - exposures_.begin());
  disk_is_full_ = !lost.attempt([&] { overwrite(raw_file(folder, slot), image); });
  *oldest = disk_is_full_ ? kFree : image.exposure_tick;
}

std::optional<RawImage> RawImages::find(const std::filesystem::path& folder, std::int64_t exposure_tick) const {
  const auto found = std::find(exposures_.begin(), exposures_.end(), exposure_tick);
  if (exposure_tick == kFree || found == exposures_.end()) return {};
  std::ifstream stream(raw_file(folder, static_cast<std::size_t>(found - exposures_.begin())), std::ios::binary);
  RawHeader header;
  stream.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!stream || header.exposure_tick != exposure_tick) return {};
  RawImage image{header.width, header.height, {}};
  image.rgb.resize(std::size_t{header.width} * header.height * 3);
  stream.read(reinterpret_cast<char*>(image.rgb.data()), static_cast<std::streamsize>(image.rgb.size()));
  if (!stream) return {};
  return image;
}

void RawImages::forget_before(std::int64_t exposure_tick) {
  processed_tick_ = exposure_tick;
  for (std::int64_t& exposure : exposures_)
    if (exposure < exposure_tick) exposure = kFree;
}

}  // namespace constrictor::report
