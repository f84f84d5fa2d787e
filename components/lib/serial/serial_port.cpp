#include "serial/serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

namespace constrictor::serial {
namespace {

constexpr int kLongestWrite_ms = 100;

std::string advice(int error) {
  switch (error) {
    case ENOENT:
      return "is the adapter plugged in, and is the name right? `ls -l /dev/serial/by-id` lists the adapters";
    case EACCES:
    case EPERM:
      return "may this user use it? `sudo usermod -aG dialout $USER`, then log in again";
    case EBUSY:
    case EWOULDBLOCK:
      return "another program uses it: end that program";
    default:
      return "is it a serial port?";
  }
}

}  // namespace

SerialPort::SerialPort(const std::filesystem::path& device, std::uint32_t baud) : name_(device.string()), baud_(baud) {
  const auto fail = [&](const char* what) {
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw PortError(fmt::format("port {}: {}: {} ({})", name_, what, ::strerrordesc_np(error), advice(error)));
  };
  descriptor_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot be opened");
  // Two programs at one port would mix their packets. The lock ends with the process, however it ends.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) fail("cannot be locked");
  termios2 settings{};
  if (::ioctl(descriptor_, TCGETS2, &settings) != 0) fail("has no settings");
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  if (::ioctl(descriptor_, TCSETS2, &settings) != 0) fail("refuses its settings");
  termios2 found{};
  if (::ioctl(descriptor_, TCGETS2, &found) != 0) fail("has no settings");
  const double error = std::abs(static_cast<double>(found.c_ospeed) - baud) / baud;
  if (error > 0.02) {
    errno = EINVAL;
    fail(fmt::format("has {} instead of {} bit/s", found.c_ospeed, baud).c_str());
  }
  serial_struct adapter{};
  if (::ioctl(descriptor_, TIOCGSERIAL, &adapter) == 0) {
    adapter.flags |= ASYNC_LOW_LATENCY;
    ::ioctl(descriptor_, TIOCSSERIAL, &adapter);
  }
  drop_input();
}

SerialPort::~SerialPort() { ::close(descriptor_); }

void SerialPort::drop_input() { ::ioctl(descriptor_, TCFLSH, TCIFLUSH); }

std::int64_t SerialPort::now_ns() const {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void SerialPort::write(dynamixel::ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      continue;
    }
    if (count < 0 && errno == EINTR) continue;
    pollfd wait{descriptor_, POLLOUT, 0};
    const bool full = count < 0 && errno == EAGAIN;
    if (!full || ::poll(&wait, 1, kLongestWrite_ms) <= 0 || (wait.revents & POLLOUT) == 0)
      throw PortError(fmt::format("port {}: cannot be written: {} (was the adapter unplugged?)", name_,
                                  full ? "it takes no more bytes" : ::strerrordesc_np(errno)));
  }
}

bool SerialPort::read(dynamixel::Bytes& to, std::int64_t deadline_ns) {
  for (;;) {
    std::uint8_t buffer[4096];
    const ssize_t count = ::read(descriptor_, buffer, sizeof buffer);
    if (count > 0) {
      to.insert(to.end(), buffer, buffer + count);
      return true;
    }
    if (count < 0 && errno != EAGAIN && errno != EINTR)
      throw PortError(
          fmt::format("port {}: cannot be read: {} (was the adapter unplugged?)", name_, ::strerrordesc_np(errno)));
    const std::int64_t left_ns = deadline_ns - now_ns();
    if (left_ns <= 0) return false;
    pollfd wait{descriptor_, POLLIN, 0};
    const timespec most = {left_ns / 1'000'000'000, left_ns % 1'000'000'000};
    if (::ppoll(&wait, 1, &most, nullptr) > 0 && (wait.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0)
      throw PortError(fmt::format("port {}: is gone (was the adapter unplugged?)", name_));
  }
}

std::unique_ptr<Port> wait_for_port(const std::filesystem::path& device, std::uint32_t baud, double patience_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  for (;;) {
    try {
      return std::make_unique<SerialPort>(device, baud);
    } catch (const PortError&) {
      if (std::chrono::steady_clock::now() >= end) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace constrictor::serial
