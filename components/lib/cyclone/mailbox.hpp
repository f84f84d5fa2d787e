// Datagrams that do not wake the process for which they are.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace constrictor::dds {

/// A member needs the samples of the others only when the next tick arrives. If each of them wakes the thread of
/// Cyclone DDS that receives, this costs more CPU time than the sample itself, because the caches have forgotten the
/// process. So a process of a run has a mailbox: a socket for which no thread waits. A sender of the same host puts
/// datagrams that may wait into it, and the receiving thread empties it when an ordinary datagram arrives, before it
/// passes on that one. Ordinary datagrams are ticks, heartbeats, and everything from processes that know no mailboxes.
///
/// A process whose members do not step at each tick needs the ticks between only when the next tick comes at which one
/// of them steps. It has a second mailbox for them, whose name contains the period.
///
/// A mailbox takes about ten datagrams. What it does not take, and what is for a process without a mailbox, is sent as
/// an ordinary datagram. So nothing depends on mailboxes but the CPU time.
///
/// It works because the program's function `recvmsg` (mailbox.cpp) stands in for that of the C library. A program in
/// which it does not has no mailbox.
class Mailbox {
 public:
  /// From now on, each domain that this process joins has a mailbox. Cannot be undone. Any thread may call it.
  static void open_for_this_process();
  /// From now on, ticks whose index is not a multiple of `period_ticks` (at least 2) may wait in the second mailbox of
  /// this process. Any thread may call it, once.
  static void let_ticks_wait(std::int64_t period_ticks);

  /// As long as an object of this class exists, the mailboxes of this process are emptied at once. Any thread may
  /// create it. Datagrams that are in a mailbox already are received soon after.
  class EmptiedAtOnce {
   public:
    EmptiedAtOnce();
    EmptiedAtOnce(const EmptiedAtOnce&) = delete;
    EmptiedAtOnce& operator=(const EmptiedAtOnce&) = delete;
    ~EmptiedAtOnce();
  };

  /// The number of datagrams that this process has taken out of its mailboxes.
  [[nodiscard]] static std::uint64_t taken();
};

/// Puts datagrams into the mailboxes of other processes. Belongs to one thread.
class MailSender {
 public:
  MailSender() = default;
  MailSender(const MailSender&) = delete;
  MailSender& operator=(const MailSender&) = delete;
  ~MailSender();
  /// False if the process that receives at this UDP port of this host has no mailbox, or if it is full.
  [[nodiscard]] bool put(std::uint16_t port, const std::string& datagram) { return put(port, 0, datagram); }
  /// The same with the mailbox for the ticks that are no multiples of `period_ticks`.
  [[nodiscard]] bool put_tick(std::uint16_t port, std::int64_t period_ticks, const std::string& datagram) {
    return put(port, period_ticks, datagram);
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Without {
    std::uint16_t port;
    std::int64_t period_ticks;  ///< 0: the mailbox for samples
    Clock::time_point ask_again;
  };
  [[nodiscard]] bool put(std::uint16_t port, std::int64_t period_ticks, const std::string& datagram);
  int socket_ = -1;
  std::vector<Without> without_;  ///< mailboxes that were not found
};

}  // namespace constrictor::dds
