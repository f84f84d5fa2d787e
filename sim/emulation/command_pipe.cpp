#include "sim/emulation/command_pipe.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace constrictor::emulation {
namespace {

constexpr std::size_t kLongest = 4096;

}  // namespace

CommandPipe::CommandPipe(std::filesystem::path file) : file_(std::move(file)) {
  std::filesystem::remove(file_);
  // Both ends are open, so that the pipe does not end when a writer closes it.
  if (::mkfifo(file_.c_str(), 0600) != 0 || (descriptor_ = ::open(file_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) < 0)
    throw std::system_error(errno, std::generic_category(), file_.string());
}

CommandPipe::~CommandPipe() {
  ::close(descriptor_);
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
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
