#include "cli/signal_queue.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "common/interrupt.hpp"

namespace constrictor::cli {

SignalQueue::SignalQueue() {
  survive_closed_pipes();  // what a command does with its signals must not depend on who reads its output
  ::sigemptyset(&set_);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) ::sigaddset(&set_, number);
  ::pthread_sigmask(SIG_BLOCK, &set_, &before_);
  descriptor_ = ::signalfd(-1, &set_, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

SignalQueue::~SignalQueue() {
  ::close(descriptor_);
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int SignalQueue::wait(std::chrono::milliseconds bound) const {
  pollfd descriptor{descriptor_, POLLIN, 0};
  ::poll(&descriptor, 1, static_cast<int>(bound.count()));
  int received = 0;
  for (signalfd_siginfo info{}; ::read(descriptor_, &info, sizeof(info)) == sizeof(info);) {
    if (info.ssi_signo != SIGCHLD) received = static_cast<int>(info.ssi_signo);
  }
  return received;
}

}  // namespace constrictor::cli
