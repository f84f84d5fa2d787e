#include "sim/servo_emulator/pseudo_terminal.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace constrictor::servo_emulator {
namespace {

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::filesystem::path link) : link_(std::move(link)) { open(); }

PseudoTerminal::~PseudoTerminal() { plug(false); }

void PseudoTerminal::plug(bool in) {
  if (in && master_ < 0) open();
  if (!in && master_ >= 0) close();
}

void PseudoTerminal::open() {
  master_ = checked(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "posix_openpt");
  checked(::grantpt(master_), "grantpt");
  checked(::unlockpt(master_), "unlockpt");
  char name[128];
  if (::ptsname_r(master_, name, sizeof name) != 0) checked(-1, "ptsname");
  held_open_ = checked(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC), name);
  termios2 settings{};
  checked(::ioctl(held_open_, TCGETS2, &settings), "TCGETS2");
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  checked(::ioctl(held_open_, TCSETS2, &settings), "TCSETS2");
  std::filesystem::remove(link_);
  std::filesystem::create_symlink(name, link_);
}

void PseudoTerminal::close() {
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
  ::close(held_open_);
  ::close(master_);
  held_open_ = master_ = -1;
}

std::uint32_t PseudoTerminal::baud() const {
  termios2 settings{};
  return ::ioctl(held_open_, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

void PseudoTerminal::read(dynamixel::Bytes& to) const {
  std::uint8_t buffer[4096];
  for (;;) {
    const ssize_t count = ::read(master_, buffer, sizeof buffer);
    if (count <= 0) return;
    to.insert(to.end(), buffer, buffer + count);
  }
}

void PseudoTerminal::write(dynamixel::ByteView bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::write(master_, bytes.data(), bytes.size());
    if (count <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace constrictor::servo_emulator
