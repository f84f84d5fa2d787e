#include "cyclone/gathered_sends.hpp"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "cyclone/mailbox.hpp"

// A datagram of RTPS is a header, which names the participant that sends, and submessages. Submessages set what holds
// for the following ones: the participant that is meant (INFO_DST) and the time (INFO_TS). So two datagrams with the
// same header make one: the submessages of the second one follow those of the first one, after two submessages that
// restore what holds at the beginning of a datagram.

namespace constrictor::dds {
namespace {

constexpr std::size_t kHeader = 20;           // [byte] "RTPS", version, vendor, the first 12 bytes of the GUID
constexpr std::size_t kSubmessageHeader = 4;  // [byte] id, flags, length
constexpr std::size_t kLargest = 60000;       // [byte] of a joined datagram; the kernel accepts 65,507
constexpr std::size_t kLargestPart = 20000;   // [byte] larger ones are copied for more than a system call costs

constexpr std::uint8_t kInfoTs = 0x09;
constexpr std::uint8_t kPad = 0x01;
// PAD, ACKNACK, HEARTBEAT, GAP, INFO_TS, INFO_DST, NACK_FRAG, HEARTBEAT_FRAG, DATA, DATA_FRAG, and the parts of secured
// submessages. Others may set what the two submessages below do not restore, or protect the datagram as a whole.
constexpr std::array<std::uint8_t, 13> kJoinable{kPad, 0x06, 0x07, 0x08, kInfoTs, 0x0e, 0x12,
                                                 0x13, 0x15, 0x16, 0x30, 0x31,    0x32};
// INFO_DST with the unknown participant, which means every one; INFO_TS with the flag "invalidate". Little-endian.
constexpr std::string_view kRestore("\x0e\x01\x0c\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x09\x03\x00\x00",
                                    20);

using Send = ssize_t (*)(int, const msghdr*, int);

Send send_of_c_library() {
  static const Send send = reinterpret_cast<Send>(::dlsym(RTLD_NEXT, "sendmsg"));
  return send;
}

/// Whether other submessages may stand before or behind those of this datagram.
bool joinable(std::string_view datagram) {
  if (!datagram.starts_with("RTPS") || datagram.size() < kHeader + kSubmessageHeader) return false;
  std::string_view rest = datagram.substr(kHeader);
  while (!rest.empty()) {
    if (rest.size() < kSubmessageHeader) return false;
    const auto id = static_cast<std::uint8_t>(rest[0]);
    if (std::find(kJoinable.begin(), kJoinable.end(), id) == kJoinable.end()) return false;
    const auto low = static_cast<std::uint8_t>(rest[2]);
    const auto high = static_cast<std::uint8_t>(rest[3]);
    const bool little = (static_cast<std::uint8_t>(rest[1]) & 1U) != 0;
    const std::size_t length = little ? low + 256U * high : high + 256U * low;
    // In all other submessages the length 0 means: until the end of the datagram.
    if (length == 0 && id != kPad && id != kInfoTs) return false;
    if (kSubmessageHeader + length > rest.size()) return false;
    rest.remove_prefix(kSubmessageHeader + length);
  }
  return true;
}

struct Datagram {
  int socket = -1;
  int flags = 0;
  sockaddr_in to{};
  bool may_wait = false;  ///< in the mailbox of the receiver
  std::string bytes;
};

std::atomic<std::uint64_t> g_messages = 0;
std::atomic<std::uint64_t> g_datagrams = 0;

class Gathering {
 public:
  void let_receivers_wait(bool may_wait) { may_wait_ = may_wait; }

  /// Takes the message if it can wait, and returns its size; otherwise sends it, after the messages that wait for its
  /// address.
  ssize_t send(int socket, const msghdr& message, int flags) {
    ++g_messages;
    sockaddr_in to{};
    std::size_t size = 0;
    for (std::size_t i = 0; i < message.msg_iovlen; ++i) size += message.msg_iov[i].iov_len;
    const bool addressed = message.msg_name && message.msg_namelen == sizeof to;
    if (addressed) std::memcpy(&to, message.msg_name, sizeof to);
    const bool on_this_host = addressed && to.sin_family == AF_INET && ntohl(to.sin_addr.s_addr) >> 24U == 127;
    if (!on_this_host || message.msg_controllen > 0) return send_now(socket, message, flags);
    Datagram* const waiting = find(socket, flags, to);
    bool small = size <= kLargestPart;
    if (small) {
      part_.clear();
      for (std::size_t i = 0; i < message.msg_iovlen; ++i)
        part_.append(static_cast<const char*>(message.msg_iov[i].iov_base), message.msg_iov[i].iov_len);
      small = joinable(part_);
    }
    if (!small) {
      if (waiting) send_waiting(*waiting);
      return send_now(socket, message, flags);
    }
    add(waiting ? *waiting : fresh(socket, flags, to));
    return static_cast<ssize_t>(size);
  }

  void send_all() {
    // What wakes a receiver goes last, so that the receiver then finds everything else.
    for (const bool may_wait : {true, false}) {
      for (std::size_t i = 0; i < used_; ++i) {
        if (datagrams_[i].may_wait == may_wait) send_waiting(datagrams_[i]);
      }
    }
    used_ = 0;
    may_wait_ = false;
  }

 private:
  Datagram* find(int socket, int flags, const sockaddr_in& to) {
    for (std::size_t i = 0; i < used_; ++i) {
      Datagram& one = datagrams_[i];
      if (one.socket == socket && one.flags == flags && one.to.sin_port == to.sin_port &&
          one.to.sin_addr.s_addr == to.sin_addr.s_addr)
        return &one;
    }
    return nullptr;
  }

  Datagram& fresh(int socket, int flags, const sockaddr_in& to) {
    if (used_ == datagrams_.size()) datagrams_.emplace_back();
    Datagram& one = datagrams_[used_++];
    one.socket = socket;
    one.flags = flags;
    one.to = to;
    one.bytes.clear();
    return one;
  }

  /// Appends part_.
  void add(Datagram& to) {
    const std::string_view part(part_);
    const bool same_sender = std::string_view(to.bytes).substr(0, kHeader) == part.substr(0, kHeader);
    if (!to.bytes.empty() && (!same_sender || to.bytes.size() + kRestore.size() + part.size() > kLargest))
      send_waiting(to);
    if (to.bytes.empty()) {
      to.bytes = part;
      to.may_wait = may_wait_;
    } else {
      to.bytes.append(kRestore).append(part.substr(kHeader));
      to.may_wait = to.may_wait && may_wait_;
    }
  }

  void send_waiting(Datagram& datagram) {
    if (datagram.bytes.empty()) return;
    if (datagram.may_wait && mail_.put(ntohs(datagram.to.sin_port), datagram.bytes)) {
      ++g_datagrams;
      datagram.bytes.clear();
      return;
    }
    iovec bytes{datagram.bytes.data(), datagram.bytes.size()};
    msghdr message{};
    message.msg_name = &datagram.to;
    message.msg_namelen = sizeof datagram.to;
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    // A datagram that the kernel does not accept is lost like one in a network, and DDS sends the samples again.
    while (send_now(datagram.socket, message, datagram.flags) < 0 && errno == EINTR) continue;
    datagram.bytes.clear();
  }

  static ssize_t send_now(int socket, const msghdr& message, int flags) {
    ++g_datagrams;
    return send_of_c_library()(socket, &message, flags);
  }

  std::vector<Datagram> datagrams_;  // the first used_ ones wait; all keep their memory
  std::size_t used_ = 0;
  std::string part_;
  bool may_wait_ = false;  ///< of what is sent now
  MailSender mail_;
};

thread_local int t_objects = 0;  // apart, because threads that end may still send
thread_local Gathering t_gathering;

}  // namespace

GatheredSends::GatheredSends(Receivers receivers) {
  if (t_objects++ == 0) t_gathering.let_receivers_wait(receivers == Receivers::kMayWait);
}

void GatheredSends::wake_receivers() { t_gathering.let_receivers_wait(false); }

GatheredSends::~GatheredSends() {
  if (--t_objects == 0) t_gathering.send_all();
}

GatheredSends::Counts GatheredSends::counts() { return {g_messages, g_datagrams}; }

}  // namespace constrictor::dds

/// Stands in for the function of the C library in the programs that use GatheredSends.
extern "C" __attribute__((visibility("default"))) ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  using namespace constrictor::dds;
  if (message && t_objects > 0) return t_gathering.send(socket, *message, flags);
  return send_of_c_library()(socket, message, flags);
}
