// Datagrams that do not wake the process that receives them.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace constrictor::dds {

/// A member needs the samples of the others only when the next tick arrives. If each of them wakes the thread of
/// Cyclone DDS that receives, this costs more CPU time than the sample itself, because the caches have forgotten the
/// process. So a process of a run has a mailbox: a socket for which no thread waits. A sender of the same host puts
/// datagrams that may wait into it, and the receiving thread empties it when an ordinary datagram arrives, before it
/// passes on that one. Ordinary datagrams are ticks, heartbeats, and everything from processes that know no mailboxes.
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

  /// As long as an object of this class exists, the mailboxes of this process are emptied at once. Any thread may
  /// create it. Datagrams that are in a mailbox already are received soon after.
  class EmptiedAtOnce {
   public:
    EmptiedAtOnce();
    EmptiedAtOnce(const EmptiedAtOnce&) = delete;
    EmptiedAtOnce& operator=(const EmptiedAtOnce&) = delete;
    ~EmptiedAtOnce();
  };

  /// As long as an object of this class exists, the threads that receive call a function whenever they have passed on
  /// everything that has arrived, in the mailbox and otherwise, before they wait for more. Only one object may exist at
  /// a time.
  class BeforeWaiting {
   public:
    explicit BeforeWaiting(std::function<void()> call);
    BeforeWaiting(const BeforeWaiting&) = delete;
    BeforeWaiting& operator=(const BeforeWaiting&) = delete;
    ~BeforeWaiting();  ///< waits until no thread calls the function any more
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
  [[nodiscard]] bool put(std::uint16_t port, const std::string& datagram);

 private:
  using Clock = std::chrono::steady_clock;
  struct Without {
    std::uint16_t port;
    Clock::time_point ask_again;
  };
  int socket_ = -1;
  std::vector<Without> without_;  ///< ports at which no mailbox was found
};

}  // namespace constrictor::dds
