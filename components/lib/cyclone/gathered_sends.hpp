// Joins what one thread sends to the same process of this host into one datagram.
#pragma once

#include <cstdint>

namespace constrictor::dds {

/// Cyclone DDS sends a datagram for each sample and each process that reads it. Each of them costs the sender a system
/// call and wakes a thread of the receiver, which needs more CPU time than most of the samples themselves. While an
/// object of this class exists, messages from its thread to addresses 127.x.x.x wait; the destructor sends all messages
/// that wait for one address as one datagram. To other addresses nothing changes: there a lost datagram would take more
/// samples with it.
///
/// It works because the program's function `sendmsg` (gathered_sends.cpp) stands in for that of the C library. A
/// program in which it does not, for example a Python module, sends each sample for itself, which is also right.
class GatheredSends {
 public:
  enum class Receivers {
    kWake,
    kMayWait,  ///< until they receive something else, see Mailbox
  };
  explicit GatheredSends(Receivers receivers = Receivers::kWake);
  GatheredSends(const GatheredSends&) = delete;
  GatheredSends& operator=(const GatheredSends&) = delete;
  /// Sends what waits, unless another object of this thread is still there.
  ~GatheredSends();

  /// What this thread sends from now on until the object is destroyed wakes the processes to which it goes.
  static void wake_receivers();

  struct Counts {
    std::uint64_t messages = 0;   ///< that Cyclone DDS gave to the kernel while an object existed
    std::uint64_t datagrams = 0;  ///< in which they were sent
  };
  /// The counts of this process, since it began.
  [[nodiscard]] static Counts counts();
};

}  // namespace constrictor::dds
