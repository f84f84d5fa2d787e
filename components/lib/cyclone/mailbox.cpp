#include "cyclone/mailbox.hpp"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string_view>
#include <utility>

namespace constrictor::dds {
namespace {

constexpr std::size_t kLargestDatagram = 65536;  // [byte] of a datagram
constexpr std::size_t kBatch = 12;               // datagrams; Linux keeps 11 in a socket by default
constexpr auto kAskAgain = std::chrono::seconds(1);
/// The name of Cyclone's thread that receives the messages of the topics, and nothing else.
constexpr std::string_view kReceivingThread = "recvUC";

std::atomic<bool> g_open = false;
std::atomic<int> g_emptied_at_once = 0;
std::atomic<std::uint64_t> g_taken = 0;
std::shared_mutex g_before_waiting_mutex;
std::function<void()> g_before_waiting;
std::atomic<bool> g_calls = false;

void call_before_waiting() {
  const std::shared_lock lock(g_before_waiting_mutex);
  if (g_before_waiting) g_before_waiting();
}

using Receive = ssize_t (*)(int, msghdr*, int);

Receive receive_of_c_library() {
  static const Receive receive = reinterpret_cast<Receive>(::dlsym(RTLD_NEXT, "recvmsg"));
  return receive;
}

/// The address of the mailbox that belongs to a UDP port. A name that begins with a zero is no file: the kernel forgets
/// it with the socket, and like the ports it belongs to a network namespace.
struct Address {
  explicit Address(std::uint16_t port) {
    un.sun_family = AF_UNIX;
    const auto name = fmt::format_to_n(un.sun_path + 1, sizeof un.sun_path - 1, "constrictor.mailbox.{}", port);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size);
  }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&un); }
  sockaddr_un un{};
  socklen_t size = 0;
};

/// The UDP address to which a socket is bound; empty if it is of another kind.
std::optional<sockaddr_in> own_address(int socket) {
  int type = 0;
  socklen_t size = sizeof type;
  sockaddr_in address{};
  socklen_t address_size = sizeof address;
  if (::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM ||
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &address_size) != 0 ||
      address.sin_family != AF_INET || address.sin_port == 0)
    return {};
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// What a datagram consists of: its bytes, and the address of the sender.
struct Mail {
  std::unique_ptr<char[]> bytes = std::make_unique_for_overwrite<char[]>(kLargestDatagram);
  std::size_t size = 0;
  sockaddr_in from{};

  /// Copies itself to the place that the caller of recvmsg() has for a datagram.
  ssize_t deliver(msghdr& message) const {
    const std::size_t copied = std::min(size, message.msg_iov->iov_len);
    std::memcpy(message.msg_iov->iov_base, bytes.get(), copied);
    if (message.msg_name && message.msg_namelen >= sizeof from) {
      std::memcpy(message.msg_name, &from, sizeof from);
      message.msg_namelen = sizeof from;
    }
    message.msg_flags = copied < size ? MSG_TRUNC : 0;
    message.msg_controllen = 0;
    return static_cast<ssize_t>(copied);
  }
};

/// The mailbox of the domain whose messages the present thread receives.
class ReceivingMailbox {
 public:
  ReceivingMailbox(int udp_socket, const sockaddr_in& address) : udp_socket_(udp_socket), address_(address) {
    const Address name(ntohs(address.sin_port));
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ >= 0 && ::bind(socket_, name.get(), name.size) != 0) {
      ::close(socket_);
      socket_ = -1;
    }
    for (std::size_t i = 0; i < kBatch; ++i) {
      places_.at(i) = {mails_.at(i).bytes.get(), kLargestDatagram};
      mails_.at(i).from = address;
      headers_.at(i).msg_hdr.msg_iov = &places_.at(i);
      headers_.at(i).msg_hdr.msg_iovlen = 1;
    }
    const std::lock_guard lock(s_mutex);
    s_all.push_back(this);
  }
  ReceivingMailbox(const ReceivingMailbox&) = delete;
  ReceivingMailbox& operator=(const ReceivingMailbox&) = delete;
  ~ReceivingMailbox() {
    {
      const std::lock_guard lock(s_mutex);
      std::erase(s_all, this);
    }
    if (socket_ >= 0) ::close(socket_);
  }

  [[nodiscard]] bool is_of(int udp_socket) const { return socket_ >= 0 && udp_socket == udp_socket_; }

  /// Stands in for recvmsg() on the UDP socket.
  ssize_t receive(msghdr& message) {
    if (next_ < count_) return mails_.at(next_++).deliver(message);
    if (waiting_.size > 0) {
      const ssize_t size = waiting_.deliver(message);
      waiting_.size = 0;
      return size;
    }
    ssize_t size = -1;
    if (g_calls) {
      size = receive_of_c_library()(udp_socket_, &message, MSG_DONTWAIT);
      if (size < 0) call_before_waiting();
    }
    while (size < 0) {
      const bool at_once = g_emptied_at_once.load() > 0;
      if (at_once) {
        std::array<pollfd, 2> both{pollfd{udp_socket_, POLLIN, 0}, pollfd{socket_, POLLIN, 0}};
        if (::poll(both.data(), both.size(), -1) < 0) return -1;
        if (both[0].revents == 0 && take_out()) return mails_.at(next_++).deliver(message);
      }
      size = receive_of_c_library()(udp_socket_, &message, at_once ? MSG_DONTWAIT : 0);
      if (size < 0 && errno != EAGAIN) return size;
    }
    if (size <= 0 || !take_out()) return size;
    // What was in the mailbox comes first, because it was sent first.
    const auto* bytes = static_cast<const char*>(message.msg_iov->iov_base);
    std::copy_n(bytes, size, waiting_.bytes.get());
    waiting_.size = static_cast<std::size_t>(size);
    waiting_.from = address_;
    if (message.msg_name && message.msg_namelen == sizeof waiting_.from)
      std::memcpy(&waiting_.from, message.msg_name, sizeof waiting_.from);
    return mails_.at(next_++).deliver(message);
  }

  /// Ends the receive() of each mailbox, in any thread.
  static void wake_all() {
    const std::lock_guard lock(s_mutex);
    for (const ReceivingMailbox* one : s_all)
      ::sendto(one->udp_socket_, "", 1, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&one->address_),
               sizeof one->address_);
  }

 private:
  /// Takes the datagrams out of the mailbox. False if it is empty.
  bool take_out() {
    const int found = ::recvmmsg(socket_, headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
    next_ = 0;
    count_ = static_cast<std::size_t>(std::max(found, 0));
    for (std::size_t i = 0; i < count_; ++i) {
      const bool whole = (headers_.at(i).msg_hdr.msg_flags & MSG_TRUNC) == 0;
      mails_.at(i).size = whole ? headers_.at(i).msg_len : 0;
    }
    g_taken += count_;
    return count_ > 0;
  }

  inline static std::mutex s_mutex;
  inline static std::vector<const ReceivingMailbox*> s_all;

  int udp_socket_;
  int socket_ = -1;
  sockaddr_in address_;  ///< of this process
  std::array<Mail, kBatch> mails_;
  std::array<iovec, kBatch> places_{};
  std::array<mmsghdr, kBatch> headers_{};
  std::size_t next_ = 0;  ///< of mails_
  std::size_t count_ = 0;
  Mail waiting_;  ///< the ordinary datagram that woke the thread; size 0: none
};

thread_local bool t_asked = false;
thread_local std::optional<ReceivingMailbox> t_mailbox;

/// The mailbox of the present thread, if it is the one that receives from this socket.
ReceivingMailbox* mailbox_of(int socket) {
  if (!t_asked) {
    t_asked = true;
    std::array<char, 32> name{};
    const bool receives = ::pthread_getname_np(::pthread_self(), name.data(), name.size()) == 0 &&
                          std::string_view(name.data()) == kReceivingThread;
    if (const auto address = receives ? own_address(socket) : std::nullopt) t_mailbox.emplace(socket, *address);
  }
  return t_mailbox && t_mailbox->is_of(socket) ? &*t_mailbox : nullptr;
}

}  // namespace

void Mailbox::open_for_this_process() { g_open = true; }

std::uint64_t Mailbox::taken() { return g_taken; }

Mailbox::BeforeWaiting::BeforeWaiting(std::function<void()> call) {
  const std::unique_lock lock(g_before_waiting_mutex);
  g_before_waiting = std::move(call);
  g_calls = true;
}

Mailbox::BeforeWaiting::~BeforeWaiting() {
  const std::unique_lock lock(g_before_waiting_mutex);
  g_before_waiting = nullptr;
  g_calls = false;
}

Mailbox::EmptiedAtOnce::EmptiedAtOnce() {
  ++g_emptied_at_once;
  ReceivingMailbox::wake_all();
}

Mailbox::EmptiedAtOnce::~EmptiedAtOnce() { --g_emptied_at_once; }

MailSender::~MailSender() {
  if (socket_ >= 0) ::close(socket_);
}

bool MailSender::put(std::uint16_t port, const std::string& datagram) {
  const auto without =
      std::find_if(without_.begin(), without_.end(), [port](const Without& one) { return one.port == port; });
  if (without != without_.end()) {
    if (Clock::now() < without->ask_again) return false;
    without_.erase(without);
  }
  if (socket_ < 0) socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const Address to(port);
  const ssize_t sent = ::sendto(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT, to.get(), to.size);
  if (sent >= 0) return true;
  if (errno != EAGAIN) without_.push_back({port, Clock::now() + kAskAgain});
  return false;
}

}  // namespace constrictor::dds

/// Stands in for the function of the C library in the programs that have mailboxes.
extern "C" __attribute__((visibility("default"))) ssize_t recvmsg(int socket, msghdr* message, int flags) {
  using namespace constrictor::dds;
  if (g_open.load(std::memory_order_relaxed) && message && message->msg_iovlen == 1 && flags == 0) {
    if (ReceivingMailbox* mailbox = mailbox_of(socket)) return mailbox->receive(*message);
  }
  return receive_of_c_library()(socket, message, flags);
}
