#include "recording/mcap_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace constrictor::mcap {

File::File(std::filesystem::path path, Mode mode) : path_(std::move(path)) {
  const int flags = mode == Mode::kRead ? O_RDONLY : mode == Mode::kCreate ? O_RDWR | O_CREAT : O_RDWR;
  descriptor_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0600);
  if (descriptor_ < 0) fail("cannot be opened", errno);
  struct stat status {};
  const bool regular = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  // The kernel frees the lock when the process ends in any way.
  const bool in_use =
      regular && mode != Mode::kRead && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!regular || in_use) {
    ::close(descriptor_);
    throw Error(path_.string() + (in_use ? ": another process is writing it; wait until it has ended"
                                         : ": found no regular file, accepted an MCAP file"));
  }
  if (mode == Mode::kCreate && ::ftruncate(descriptor_, 0) != 0) {
    const int error = errno;
    ::close(descriptor_);
    fail("cannot be emptied", error);
  }
}

File::~File() { ::close(descriptor_); }

void File::fail(const char* what, int error) const {
  const std::string text = fmt::format("{}: {}: {}", path_.string(), what, std::strerror(error));
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) throw DiskFull(text);
  throw Error(text);
}

std::uint64_t File::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail("cannot be examined", errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::string File::read(std::uint64_t offset, std::uint64_t size) const {
  const std::uint64_t all = this->size();
  std::string bytes(offset < all ? std::min(size, all - offset) : 0, '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot be read", errno);
    if (count == 0) break;  // another process has made it shorter
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void File::write(std::uint64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail("cannot be written", count < 0 ? errno : ENOSPC);
    offset += static_cast<std::uint64_t>(count);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void File::truncate(std::uint64_t size) const {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("cannot be cut", errno);
}

void File::reserve(std::uint64_t offset, std::uint64_t size) const {
  // fallocate() ignores the limit of the shell (ulimit -f), but write() does.
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && offset + size > limit.rlim_cur)
    fail("cannot be written", EFBIG);
  for (;;) {
    if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset), static_cast<off_t>(size)) == 0)
      return;
    if (errno == EINTR) continue;
    if (errno == EOPNOTSUPP || errno == ENOSYS) return;
    fail("cannot be written", errno);
  }
}

void File::leave_free(std::uint64_t size, std::uint64_t more) const {
  struct statvfs disk {};
  if (::fstatvfs(descriptor_, &disk) != 0) return;
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free >= size + more) return;
  throw DiskFull(fmt::format(
      "{}: the disk is nearly full: found {:.1f} MB free, accepted at least {:.1f} MB, of which {:.1f} MB are left to "
      "other files",
      path_.string(), 1e-6 * static_cast<double>(free), 1e-6 * static_cast<double>(size + more),
      1e-6 * static_cast<double>(size)));
}

}  // namespace constrictor::mcap
