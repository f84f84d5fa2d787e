// Datagrams that may wait reach a process without waking it; nothing is lost, whether there is a mailbox, it is full,
// or there is none.
#include "cyclone/mailbox.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "constrictor/topics.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/gathered_sends.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using testing::eventually;
using Receivers = dds::GatheredSends::Receivers;

/// Two domains of this process that are one on the network, so that Cyclone DDS sends between them as between
/// processes. Both have a mailbox.
class MailboxTest : public ::testing::Test {
 protected:
  MailboxTest() {
    EXPECT_TRUE(eventually([&] {
      return waiting_.readers() == 1 && tick_.readers() == 1 && waitings_.writers() == 1 && ticks_.writers() == 1;
    }));
  }
  [[nodiscard]] dds::Entity join(std::uint32_t own) const {
    dds::Mailbox::open_for_this_process();
    return dds::create_domain(own, dds::Reach::kLoopback,
                              "<CycloneDDS><Domain><Discovery><ExternalDomainId>" + std::to_string(claim_.domain()) +
                                  "</ExternalDomainId></Discovery></Domain></CycloneDDS>");
  }
  /// Writes a sample that may wait.
  void write(std::int64_t number) const {
    const dds::GatheredSends gathered(Receivers::kMayWait);
    msg::Waiting message{};
    message.tick = number;
    waiting_.write(message);
  }
  void write_tick(std::int64_t number) const {
    msg::Tick message{};
    message.index = number;
    tick_.write(message);
  }
  /// The numbers that have been received until there are `count` of them.
  [[nodiscard]] bool receive(std::size_t count) {
    return eventually([&] {
      waitings_.take([&](const msg::Waiting& message) { received_.push_back(message.tick); });
      return received_.size() >= count;
    });
  }

  const DomainClaim claim_;
  const dds::Entity here_ = join(103);
  const dds::Entity there_ = join(104);
  const dds::Entity writing_ = dds::create_participant(103, dds::Reach::kLoopback, {});
  const dds::Entity reading_ = dds::create_participant(104, dds::Reach::kLoopback, {});
  const dds::Writer<msg::Waiting> waiting_{writing_.get(), "mail", 256};
  const dds::Writer<msg::Tick> tick_{writing_.get(), barrier_topics::kTick};
  const dds::Reader<msg::Waiting> waitings_ = dds::Reader<msg::Waiting>::member(reading_.get(), "mail");
  const dds::Reader<msg::Tick> ticks_ = dds::Reader<msg::Tick>::member(reading_.get(), barrier_topics::kTick.name);
  std::vector<std::int64_t> received_;
};

TEST_F(MailboxTest, MailIsThereBeforeTheDatagramThatWakesTheReceiver) {
  // A thread opens its mailbox when it begins to receive. A sender that is earlier does without for a second.
  std::size_t sent = 0;
  ASSERT_TRUE(eventually([&] {
    write(-1);
    write_tick(-1);
    return receive(++sent) && dds::Mailbox::taken() > 0;
  }));
  received_.clear();
  const std::uint64_t taken_before = dds::Mailbox::taken();
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 0; i < 200; ++i) {
    write(2 * i);
    write(2 * i + 1);
    expected.insert(expected.end(), {2 * i, 2 * i + 1});
    write_tick(i);
    std::int64_t newest = -1;
    ASSERT_TRUE(eventually([&] {
      ticks_.take([&](const msg::Tick& message) { newest = message.index; });
      return newest == i;
    }));
    waitings_.take([&](const msg::Waiting& message) { received_.push_back(message.tick); });
    ASSERT_EQ(received_, expected);
  }
  EXPECT_GE(dds::Mailbox::taken() - taken_before, 400U);
}

TEST_F(MailboxTest, WhatTheMailboxDoesNotTakeArrivesToo) {
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 0; i < 200; ++i) {
    write(i);
    expected.push_back(i);
  }
  write_tick(0);
  ASSERT_TRUE(receive(expected.size()));
  EXPECT_EQ(received_, expected);
}

TEST_F(MailboxTest, IsEmptiedAtOnceOnRequest) {
  write(1);
  {
    const dds::Mailbox::EmptiedAtOnce at_once;
    ASSERT_TRUE(receive(1));
    for (std::int64_t i = 2; i < 50; ++i) {
      write(i);
      ASSERT_TRUE(receive(static_cast<std::size_t>(i)));
    }
  }
  write(50);
  write_tick(0);
  ASSERT_TRUE(receive(50));
}

TEST_F(MailboxTest, TheFunctionBeforeAWaitIsCalledWhenEverythingHasBeenPassedOn) {
  constexpr std::size_t kTicks = 40;
  std::atomic<bool> held = true;
  std::atomic<std::size_t> calls = 0;
  std::mutex mutex;
  std::vector<std::size_t> batches;
  std::size_t sum = 0;
  const dds::Mailbox::BeforeWaiting before_waiting([&] {
    ++calls;
    while (held) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex);
    std::size_t taken = 0;
    ticks_.take([&](const msg::Tick&) { ++taken; });
    if (taken > 0) batches.push_back(taken);
    sum += taken;
  });
  // The threads that receive for the reader and for the writer are held in the function.
  ASSERT_TRUE(eventually([&] {
    write_tick(0);
    return calls >= 1;
  }));
  for (std::size_t i = 0; i < kTicks; ++i) write_tick(1);
  held = false;
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return sum > kTicks;
  }));
  const std::lock_guard lock(mutex);
  EXPECT_LT(batches.size(), kTicks / 2) << "called between datagrams that had arrived";
}

TEST_F(MailboxTest, HeartbeatsBringTheMailOfASilentWriter) {
  write(7);  // nothing else is sent
  ASSERT_TRUE(receive(1));
}

TEST(MailSender, FindsNoMailboxAtAPortWithoutOne) {
  dds::MailSender sender;
  EXPECT_FALSE(sender.put(1, "mail"));
  EXPECT_FALSE(sender.put(1, "mail"));
}

}  // namespace
}  // namespace constrictor
