#include "sim/emulation/command_pipe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "configuration/configuration.hpp"

namespace constrictor::emulation {
namespace {

constexpr std::size_t kLongest = 4096;

}  // namespace

CommandPipe::CommandPipe(std::filesystem::path file) : file_(std::move(file)) {
  // The kernel releases the lock when the process ends, however it ends.
  while (!claim()) {}
}

bool CommandPipe::claim() {
  const auto fail = [this] { throw std::system_error(errno, std::generic_category(), file_.string()); };
  if (::mkfifo(file_.c_str(), 0600) != 0 && errno != EEXIST) fail();
  // Both ends are open, so that the pipe does not end when a writer closes it.
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0 && errno == ENOENT) return false;  // its owner has ended meanwhile
  if (descriptor_ < 0) fail();
  struct stat opened {};
  struct stat named {};
  ::fstat(descriptor_, &opened);
  const bool locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  const bool present = ::stat(file_.c_str(), &named) == 0 && named.st_ino == opened.st_ino;
  if (locked && present && S_ISFIFO(opened.st_mode)) return true;
  ::close(std::exchange(descriptor_, -1));
  if (!locked)
    throw ConfigurationError(
        fmt::format("--output: {} belongs to an emulator that runs: end that one, or choose another folder",
                    std::filesystem::absolute(file_).string()));
  // A command that was written while no emulator ran has made a file.
  if (present) std::filesystem::remove(file_);
  return false;
}

CommandPipe::~CommandPipe() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);  // before the lock is released: afterwards it may belong to another process
  ::close(descriptor_);
}

void CommandPipe::read(const std::function<void(const std::string& line)>& use) {
  char buffer[512];
  for (ssize_t count = 0; (count = ::read(descriptor_, buffer, sizeof buffer)) > 0;) {
    text_.append(buffer, static_cast<std::size_t>(count));
    for (auto end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      use(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
    if (text_.size() > kLongest) text_.clear();
  }
}

}  // namespace constrictor::emulation
