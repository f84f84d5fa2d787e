#include "cli/run_ending.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr RunEnding::Time kStart{100s};

TEST(RunEnding, AsksTheConductorAfterTheFirstSignal) {
  RunEnding ending;
  EXPECT_FALSE(ending.requested());
  EXPECT_EQ(ending.kill_reason(kStart), "");
  ending.signal_received(SIGINT, true, kStart);
  EXPECT_TRUE(ending.wants_answer());
  EXPECT_EQ(ending.first_signal(), SIGINT);
  EXPECT_EQ(ending.kill_reason(kStart), "");
  ending.accepted(kStart);
  EXPECT_FALSE(ending.wants_answer());
  EXPECT_EQ(ending.kill_reason(kStart + RunEnding::kEndBound), "");
}

TEST(RunEnding, KillsWhenTheRunDoesNotEnd) {
  RunEnding ending;
  ending.signal_received(SIGTERM, true, kStart);
  ending.accepted(kStart);
  EXPECT_NE(ending.kill_reason(kStart + RunEnding::kEndBound + 1ms).find("did not end within 60 s"), std::string::npos);
  EXPECT_FALSE(ending.at_once());
}

TEST(RunEnding, KillsAtOnceAfterTheSecondSignal) {
  RunEnding ending;
  ending.signal_received(SIGTERM, true, kStart);
  ending.accepted(kStart);
  ending.signal_received(SIGINT, true, kStart + RunEnding::kSameWish);
  EXPECT_EQ(ending.kill_reason(kStart), "a second signal arrived");
  EXPECT_TRUE(ending.at_once());
  EXPECT_EQ(ending.first_signal(), SIGTERM);
}

TEST(RunEnding, TreatsSignalsWithinAShortTimeAsOne) {
  RunEnding ending;
  ending.signal_received(SIGINT, true, kStart);
  ending.signal_received(SIGINT, true, kStart + RunEnding::kSameWish - 1ms);
  EXPECT_FALSE(ending.at_once());
  EXPECT_TRUE(ending.wants_answer());
  EXPECT_EQ(ending.kill_reason(kStart), "");
}

TEST(RunEnding, KillsARunThatHasNotBegunWithoutAskingTheConductor) {
  RunEnding ending;
  ending.signal_received(SIGINT, false, kStart);
  EXPECT_FALSE(ending.wants_answer());
  EXPECT_EQ(ending.kill_reason(kStart), "the run had not begun");
}

TEST(RunEnding, KillsWhenTheConductorRefusesAndGivesTheReason) {
  RunEnding ending;
  ending.signal_received(SIGINT, true, kStart);
  ending.failed("no answer within 5 s");
  EXPECT_FALSE(ending.wants_answer());
  EXPECT_EQ(ending.kill_reason(kStart), "no answer within 5 s");
}

}  // namespace
}  // namespace constrictor::cli
