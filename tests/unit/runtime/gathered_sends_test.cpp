// What one thread sends to one process of this host while GatheredSends exists arrives as one datagram that contains
// all submessages; what may not be joined arrives as it is.
#include "cyclone/gathered_sends.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <vector>

#include "constrictor/topics.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::string_literals;
using testing::eventually;

/// A socket on 127.0.0.1.
class Socket {
 public:
  Socket() : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<const sockaddr*>(&address_), sizeof address_), 0);
    socklen_t size = sizeof address_;
    EXPECT_EQ(::getsockname(fd_, reinterpret_cast<sockaddr*>(&address_), &size), 0);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() { ::close(fd_); }

  /// As Cyclone DDS sends: in pieces, by sendmsg.
  void send(std::string bytes, const sockaddr_in& to) const {
    const std::size_t half = bytes.size() / 2;
    iovec parts[2] = {{bytes.data(), half}, {bytes.data() + half, bytes.size() - half}};
    sockaddr_in address = to;
    msghdr message{};
    message.msg_name = &address;
    message.msg_namelen = sizeof address;
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    EXPECT_EQ(::sendmsg(fd_, &message, 0), static_cast<ssize_t>(bytes.size()));
  }
  /// Everything that has arrived. On the loopback interface, that is everything that was sent.
  [[nodiscard]] std::vector<std::string> received() const {
    std::vector<std::string> all;
    std::string bytes(70000, '\0');
    for (ssize_t size = 0; (size = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT)) >= 0;)
      all.push_back(bytes.substr(0, static_cast<std::size_t>(size)));
    return all;
  }
  [[nodiscard]] const sockaddr_in& address() const { return address_; }

 private:
  int fd_;
  sockaddr_in address_{};
};

std::string header(char participant = 'p') { return "RTPS\x02\x01\x01\x10"s + std::string(12, participant); }

std::string submessage(char id, const std::string& content) {
  return {id + "\x01"s + static_cast<char>(content.size() & 0xff) + static_cast<char>(content.size() >> 8) + content};
}

constexpr char kData = 0x15, kHeartbeat = 0x07, kInfoDst = 0x0e, kProtectedAsAWhole = 0x33;

/// The submessages of a datagram: those that set a state with it, as "id:content".
std::vector<std::string> submessages(const std::string& datagram) {
  std::vector<std::string> all;
  for (std::size_t at = 20; at + 4 <= datagram.size();) {
    const std::size_t length =
        static_cast<std::uint8_t>(datagram[at + 2]) + 256U * static_cast<std::uint8_t>(datagram[at + 3]);
    all.push_back(std::to_string(datagram[at]) + ":" + datagram.substr(at + 4, length));
    at += 4 + length;
  }
  return all;
}

class GatheredSendsTest : public ::testing::Test {
 protected:
  /// Sends `messages` to one socket while GatheredSends exists.
  std::vector<std::string> gathered(const std::vector<std::string>& messages) const {
    {
      const dds::GatheredSends gathered;
      for (const auto& message : messages) sender_.send(message, receiver_.address());
    }
    return receiver_.received();
  }
  const Socket sender_;
  const Socket receiver_;
  const std::string first_ = header() + submessage(kInfoDst, std::string(12, 'd')) + submessage(kHeartbeat, "a--a");
  const std::string second_ = header() + submessage(kData, "bbbb") + submessage(kHeartbeat, "b--b");
};

TEST_F(GatheredSendsTest, ArriveAsOneDatagramThatIsSentAtTheEnd) {
  {
    const dds::GatheredSends outer;
    {
      const dds::GatheredSends inner;
      sender_.send(first_, receiver_.address());
    }
    sender_.send(second_, receiver_.address());
    EXPECT_TRUE(receiver_.received().empty());
  }
  const auto datagrams = receiver_.received();
  ASSERT_EQ(datagrams.size(), 1U);
  EXPECT_EQ(datagrams.front().substr(0, 20), header());
  // Between the two, the participant that is meant is again "every one", and the time is not known (flags 3).
  const std::vector<std::string> expected{
      "14:" + std::string(12, 'd'), "7:a--a", "14:" + std::string(12, '\0'), "9:", "21:bbbb", "7:b--b"};
  EXPECT_EQ(submessages(datagrams.front()), expected);
  EXPECT_NE(datagrams.front().find("\x09\x03\x00\x00"s), std::string::npos);
}

TEST_F(GatheredSendsTest, WithoutAnObjectEachMessageIsADatagram) {
  sender_.send(first_, receiver_.address());
  sender_.send(second_, receiver_.address());
  EXPECT_EQ(receiver_.received(), (std::vector{first_, second_}));
}

TEST_F(GatheredSendsTest, OtherThreadsAreNotConcerned) {
  const dds::GatheredSends gathered;
  std::thread([&] { sender_.send(first_, receiver_.address()); }).join();
  EXPECT_EQ(receiver_.received(), (std::vector{first_}));
}

TEST_F(GatheredSendsTest, MessagesThatMayNotBeJoinedArriveAsTheyAreAndInOrder) {
  const std::string last_without_length = header() + "\x15\x01\x00\x00"s + "until the end";
  const std::string secured = header() + submessage(kProtectedAsAWhole, "????");
  const std::string longer_than_it_is = header() + "\x15\x01\x09\x00"s + "short";
  const std::string large = header() + submessage(kData, std::string(25000, 'l'));
  const std::string of_another_participant = header('q') + submessage(kData, "qqqq");
  for (const auto& other :
       {last_without_length, secured, longer_than_it_is, large, of_another_participant, "text"s, ""s})
    EXPECT_EQ(gathered({first_, other, second_}), (std::vector{first_, other, second_})) << other.substr(0, 40);
}

TEST_F(GatheredSendsTest, ADatagramIsSentBeforeItGetsTooLargeForTheKernel) {
  const std::string large = header() + submessage(kData, std::string(19000, 'l'));
  const auto datagrams = gathered({large, large, large, large, large});
  std::size_t parts = 0;
  for (const auto& datagram : datagrams) {
    for (const auto& part : submessages(datagram)) parts += part.substr(0, 3) == "21:" ? 1 : 0;
  }
  EXPECT_EQ(datagrams.size(), 2U);
  EXPECT_EQ(parts, 5U);
}

TEST_F(GatheredSendsTest, EachAddressGetsItsOwnAndOtherHostsGetThemAtOnce) {
  const Socket other;
  sockaddr_in not_loopback = receiver_.address();
  not_loopback.sin_addr.s_addr = htonl(INADDR_ANY);  // the kernel sends it to this host, too
  const auto before = dds::GatheredSends::counts();
  {
    const dds::GatheredSends gathered;
    sender_.send(first_, receiver_.address());
    sender_.send(first_, other.address());
    sender_.send(second_, other.address());
    sender_.send(second_, not_loopback);
    EXPECT_EQ(receiver_.received(), (std::vector{second_}));
  }
  EXPECT_EQ(receiver_.received(), (std::vector{first_}));
  EXPECT_EQ(other.received().size(), 1U);
  EXPECT_EQ(dds::GatheredSends::counts().messages - before.messages, 4U);
  EXPECT_EQ(dds::GatheredSends::counts().datagrams - before.datagrams, 3U);
}

/// Two domains of this process that are one on the network, so that Cyclone DDS sends between them as between
/// processes.
class GatheredSamples : public ::testing::Test {
 protected:
  [[nodiscard]] dds::Entity join(std::uint32_t own) const {
    return dds::create_domain(own, dds::Reach::kLoopback,
                              "<CycloneDDS><Domain><Discovery><ExternalDomainId>" + std::to_string(claim_.domain()) +
                                  "</ExternalDomainId></Discovery></Domain></CycloneDDS>");
  }
  const DomainClaim claim_;
  const dds::Entity here_ = join(101);
  const dds::Entity there_ = join(102);
  const dds::Entity writing_ = dds::create_participant(101, dds::Reach::kLoopback, {});
  const dds::Entity reading_ = dds::create_participant(102, dds::Reach::kLoopback, {});
};

TEST_F(GatheredSamples, OfSeveralTopicsArriveTogetherAndComplete) {
  const dds::Writer<msg::Waiting> waiting(writing_.get(), barrier_topics::kWaiting);
  const dds::Writer<msg::Tick> tick(writing_.get(), barrier_topics::kTick);
  const dds::Writer<msg::Ready> ready(writing_.get(), barrier_topics::kReady);
  const auto waitings = dds::Reader<msg::Waiting>::member(reading_.get(), barrier_topics::kWaiting.name);
  const auto ticks = dds::Reader<msg::Tick>::member(reading_.get(), barrier_topics::kTick.name);
  const auto readies = dds::Reader<msg::Ready>::member(reading_.get(), barrier_topics::kReady.name);
  ASSERT_TRUE(eventually([&] {
    return waiting.readers() == 1 && tick.readers() == 1 && ready.readers() == 1 && waitings.writers() == 1 &&
           ticks.writers() == 1 && readies.writers() == 1;
  }));
  constexpr int kRounds = 200;
  std::vector<std::int64_t> of_waitings, of_ticks, of_readies, expected;
  const auto before = dds::GatheredSends::counts();
  for (int i = 0; i < kRounds; ++i) {
    {
      const dds::GatheredSends gathered;
      msg::Waiting first{};
      first.tick = i;
      waiting.write(first);
      msg::Tick second{};
      second.index = i;
      tick.write(second);
      msg::Ready third{};
      third.epoch = static_cast<std::uint32_t>(i);
      ready.write(third);
    }
    expected.push_back(i);
    ASSERT_TRUE(eventually([&] {
      waitings.take([&](const msg::Waiting& m) { of_waitings.push_back(m.tick); });
      ticks.take([&](const msg::Tick& m) { of_ticks.push_back(m.index); });
      readies.take([&](const msg::Ready& m) { of_readies.push_back(m.epoch); });
      return of_waitings.size() + of_ticks.size() + of_readies.size() >= 3 * expected.size();
    }));
  }
  EXPECT_EQ(of_waitings, expected);
  EXPECT_EQ(of_ticks, expected);
  EXPECT_EQ(of_readies, expected);
  EXPECT_GE(dds::GatheredSends::counts().messages - before.messages, 3U * kRounds);
  EXPECT_EQ(dds::GatheredSends::counts().datagrams - before.datagrams, kRounds);
}

}  // namespace
}  // namespace constrictor
