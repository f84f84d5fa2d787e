#include "sim/report/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include "configuration/whole_file.hpp"

namespace constrictor::report {
namespace {

std::runtime_error failure(const std::filesystem::path& path, const std::string& what) {
  return std::runtime_error(path.string() + ": " + what);
}

}  // namespace

void LostFiles::note(const NotWritten& error) {
  if (!reasons_.emplace(error.path(), error.what()).second) return;
  log_.error("{}; the run goes on without this file", error.what());
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Journal::open(std::uint64_t length) {
  std::error_code ignored;  // then the file cannot be opened either
  std::filesystem::create_directories(path_.parent_path(), ignored);
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw NotWritten(path_, std::strerror(errno));
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  if (size < static_cast<off_t>(length))
    throw failure(path_, "found a file shorter than at the checkpoint (was it cut or removed during the run?)");
  if (::ftruncate(descriptor_, static_cast<off_t>(length)) != 0) throw NotWritten(path_, std::strerror(errno));
}

void Journal::append(std::string_view text, std::uint64_t& length) {
  if (path_.empty() || ended_) return;
  ended_ = true;  // until the text is written
  if (descriptor_ < 0) open(length);
  std::uint64_t end = length;
  while (!text.empty()) {
    const ssize_t written = ::pwrite(descriptor_, text.data(), text.size(), static_cast<off_t>(end));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw NotWritten(path_, std::strerror(errno));
    end += static_cast<std::uint64_t>(written);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  length = end;
  ended_ = false;
}

std::string Journal::read(std::uint64_t length) const {
  if (path_.empty() || length == 0) return {};
  std::ifstream file(path_, std::ios::binary);
  std::string bytes(length, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(length));
  if (!file)
    throw failure(path_, "found a file shorter than at the checkpoint (was it cut or removed during the run?)");
  return bytes;
}

void replace_file(const std::filesystem::path& path, std::string_view bytes) {
  try {
    std::filesystem::create_directories(path.parent_path());
    write_whole(path, bytes);
  } catch (const std::system_error& error) {
    throw NotWritten(path, error.code().message());
  }
}

}  // namespace constrictor::report
