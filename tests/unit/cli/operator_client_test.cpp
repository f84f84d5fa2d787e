// What an operator hears from an `input` that is killed and restarted: the new process says its predecessor's last words again.
#include "cli/operator_client.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/dds/endpoint.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Answer = OperatorClient::Answer;

constexpr std::uint64_t kRun = 7;

/// An `input` that says what a test tells it to.
class OperatorClientTest : public ::testing::Test {
 protected:
  OperatorClientTest() { restart_input(); }
  /// Another process of `input`: a new writer, with the words that it kept.
  void restart_input(const std::function<void()>& after_each_word = [] {}) {
    writer_ = dds::Writer<msg::Authority>(client_.participant(), std::string(topics::kAuthority.name), 8);
    for (const msg::Authority& word : std::exchange(kept_, {})) {
      say(word);
      after_each_word();
    }
  }
  void say(const msg::Authority& word) {
    kept_.push_back(word);
    if (kept_.size() > 8) kept_.erase(kept_.begin());
    writer_.write(word);
  }
  void say(std::int64_t tick, bool stop, std::uint8_t level, std::uint32_t epoch = 1, std::uint64_t run_id = kRun, std::uint32_t incarnation = 1) {
    msg::Authority word{};
    word.header.run_id = run_id;
    word.header.epoch = epoch;
    word.header.incarnation = incarnation;
    word.header.tick = tick;
    word.header.sequence_number = static_cast<std::uint64_t>(tick) + 1;  // one a tick
    word.emergency_stop = stop;
    word.level = level;
    dds::set_text(word.source, level == msg::kAuthorityOperator ? client_.source() : "");
    say(word);
  }
  bool hears(std::int64_t tick) {
    for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(2ms)) {
      client_.poll();
      if (client_.authority() && client_.authority()->header.tick == tick) return true;
    }
    return false;
  }
  /// For a while; within a process DDS delivers what is written at once.
  void keeps_authority() {
    for (int i = 0; i < 10; ++i) {
      client_.poll();
      ASSERT_TRUE(client_.holds_authority()) << "tick " << client_.authority()->header.tick;
      std::this_thread::sleep_for(1ms);
    }
  }

  const DomainClaim claim_;
  OperatorClient client_{claim_.domain(), "hand", 0ms};
  dds::Writer<msg::Authority> writer_;
  std::vector<msg::Authority> kept_;
};

TEST_F(OperatorClientTest, AnOldStopIsNoAnswerToANewOne) {
  say(10, true, msg::kAuthorityStop);  // of before, and cleared since
  say(11, false, msg::kAuthorityNone);
  say(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(hears(12));
  const std::uint64_t stop = client_.ask(msg::kRequestEmergencyStop);
  restart_input();
  EXPECT_EQ(client_.wait_for_answer(stop, 300ms), Answer::kNone) << "nobody has heard it";
  say(13, true, msg::kAuthorityStop);
  EXPECT_EQ(client_.wait_for_answer(stop, 5s), Answer::kGranted);
}

TEST_F(OperatorClientTest, WhatIsHeardFirstIsNoAnswerEither) {
  const std::uint64_t stop = client_.ask(msg::kRequestEmergencyStop);
  say(10, true, msg::kAuthorityStop);
  ASSERT_TRUE(hears(10));
  EXPECT_EQ(client_.wait_for_answer(stop, 100ms), Answer::kNone);
  say(11, true, msg::kAuthorityStop);
  EXPECT_EQ(client_.wait_for_answer(stop, 5s), Answer::kGranted);
}

TEST_F(OperatorClientTest, AuthorityDoesNotGoBackInTime) {
  say(10, false, msg::kAuthorityNone);
  say(11, false, msg::kAuthorityPlanner);
  say(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(hears(12));
  ASSERT_TRUE(client_.holds_authority());
  restart_input([this] { keeps_authority(); });
}

TEST_F(OperatorClientTest, AnotherRunsWordIsNotOurs) {
  say(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(hears(12));
  say(40, true, msg::kAuthorityStop, 1, kRun + 1);
  keeps_authority();
  say(13, false, msg::kAuthorityOperator);
  ASSERT_TRUE(hears(13));
  EXPECT_TRUE(client_.holds_authority());
}

TEST_F(OperatorClientTest, ANewEpochBeginsAtItsFirstTickAndATickMayBeDoneAgain) {
  say(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(hears(12));
  say(0, false, msg::kAuthorityPlanner, 2);
  ASSERT_TRUE(hears(0));
  EXPECT_FALSE(client_.holds_authority());
  say(1, false, msg::kAuthorityPlanner, 2);
  ASSERT_TRUE(hears(1));
  say(1, false, msg::kAuthorityOperator, 2, kRun, 2);  // its predecessor died before anybody acted on that
  for (int i = 0; i < 1000 && !client_.holds_authority(); ++i) {
    client_.poll();
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_TRUE(client_.holds_authority());
}

}  // namespace
}  // namespace constrictor::cli
