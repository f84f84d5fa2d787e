// Links: the thread that receives can do the work of a wait, and no sample is left.
#include "runtime/links.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "constrictor/topics.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using testing::eventually;

constexpr dds_duration_t kLong_ns = DDS_SECS(30);  // never reached, unless a sample is left

/// A writer in a domain of this process that is one with that of the links on the network, so that Cyclone DDS sends
/// between them as between processes.
class LinksTest : public ::testing::Test {
 protected:
  LinksTest() {
    links_.attach(ticks_, barrier_topics::kTick.name,
                  [this](const msg::Tick& tick) { received_.push_back(tick.index); });
    EXPECT_TRUE(eventually([&] { return tick_.readers() == 1 && ticks_.writers() == 1; }));
  }
  void write(std::int64_t number) const {
    msg::Tick message{};
    message.index = number;
    tick_.write(message);
  }
  /// Writes samples until the thread that receives takes turns. It does so from the first datagram on that it receives
  /// after the call of let_receiver_turn().
  void let_receiver_turn(std::function<bool()> turn) {
    links_.let_receiver_turn([this, turn = std::move(turn)] {
      turned_in_ = std::this_thread::get_id();
      return turn();
    });
    ASSERT_TRUE(eventually([&] {
      write(-1);
      links_.wait(DDS_MSECS(10), false);
      return turned_in_ != std::thread::id();
    }));
    std::size_t before = 0;
    do {
      before = received_.size();
      links_.wait(DDS_MSECS(50), false);
    } while (received_.size() != before);
    received_.clear();
  }

  const DomainClaim claim_;
  Links links_{claim_.domain(), {}};
  const dds::Entity other_ =
      dds::create_domain(105, dds::Reach::kLoopback,
                         "<CycloneDDS><Domain><Discovery><ExternalDomainId>" + std::to_string(claim_.domain()) +
                             "</ExternalDomainId></Discovery></Domain></CycloneDDS>");
  const dds::Entity writing_ = dds::create_participant(105, dds::Reach::kLoopback, {});
  const dds::Writer<msg::Tick> tick_{writing_.get(), barrier_topics::kTick};
  const dds::Reader<msg::Tick> ticks_ =
      dds::Reader<msg::Tick>::member(links_.participant(), barrier_topics::kTick.name);
  std::vector<std::int64_t> received_;  // and the next one: by one thread at a time
  std::thread::id turned_in_;
};

TEST_F(LinksTest, TheThreadThatReceivesTakesAllSamplesAndEndsTheWaitOnRequest) {
  constexpr std::int64_t kSamples = 2000;
  bool all = false;
  let_receiver_turn([&] { return all = received_.size() >= kSamples; });
  std::thread writer([&] {
    for (std::int64_t i = 0; i < kSamples; ++i) {
      write(i);
      if (i % 7 == 0) std::this_thread::sleep_for(100us);
    }
  });
  int waits = 0;
  for (; received_.size() < kSamples && waits < 100; ++waits) links_.wait(kLong_ns, false);
  writer.join();
  EXPECT_TRUE(all);
  EXPECT_LE(waits, 2) << "samples have ended waits";
  EXPECT_NE(turned_in_, std::this_thread::get_id());
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 0; i < kSamples; ++i) expected.push_back(i);
  EXPECT_EQ(received_, expected);
}

TEST_F(LinksTest, WhatArrivesWhileNoThreadWaitsIsTakenByTheNextWait) {
  let_receiver_turn([&] { return true; });
  for (std::int64_t i = 0; i < 300; ++i) {
    write(i);
    if (i % 3 == 0) std::this_thread::sleep_for(50us);
    const auto start = Clock::now();
    while (received_.size() <= static_cast<std::size_t>(i)) links_.wait(kLong_ns, false);
    ASSERT_LT(Clock::now() - start, 15s) << i;
  }
}

TEST_F(LinksTest, WaitThrowsWhatATurnHasThrown) {
  bool fails = false;
  let_receiver_turn([&] {
    if (fails) throw std::runtime_error("a component failed");
    return false;
  });
  fails = true;
  // A sample that arrives before the wait is taken without a turn.
  std::atomic<bool> ended = false;
  std::thread writer([&] {
    for (std::int64_t i = 0; !ended; ++i) {
      write(i);
      std::this_thread::sleep_for(5ms);
    }
  });
  const auto wait_often = [&] {
    for (const auto end = Clock::now() + 20s; Clock::now() < end;) links_.wait(DDS_MSECS(100), false);
  };
  EXPECT_THROW(wait_often(), std::runtime_error);
  ended = true;
  writer.join();
}

}  // namespace
}  // namespace constrictor
