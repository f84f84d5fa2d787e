#include "client/stop_tracker.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

msg::StopState state(std::uint64_t number, bool stopped, const char* source, std::uint32_t epoch = 1) {
  msg::StopState message{};
  message.header.run_id = 7;
  message.header.epoch = epoch;
  message.number = number;
  message.stopped = stopped;
  set_text(message.source, source);
  return message;
}

TEST(StopTracker, AStopOfALaterNumberConfirmsWhoeverOrderedIt) {
  StopTracker tracker;
  tracker.take(state(3, false, "old"));
  tracker.stop_asked("me");
  tracker.take(state(3, true, "old"));
  EXPECT_FALSE(tracker.stop_latched()) << "this stop was latched before";
  tracker.take(state(4, true, "another"));
  EXPECT_TRUE(tracker.stop_latched());
  tracker.stop_asked("me");
  EXPECT_FALSE(tracker.stop_latched());
}

TEST(StopTracker, WithoutAnEarlierMessageOnlyTheOwnNameOrALaterNumberConfirms) {
  StopTracker tracker;
  tracker.stop_asked("me");
  tracker.take(state(1, true, "another"));  // may have been cleared since
  EXPECT_FALSE(tracker.stop_latched());
  tracker.take(state(1, false, "another"));
  EXPECT_FALSE(tracker.stop_latched());
  tracker.take(state(2, true, "another"));
  EXPECT_TRUE(tracker.stop_latched());

  StopTracker named;
  named.stop_asked("me");
  named.take(state(1, true, "me"));
  EXPECT_TRUE(named.stop_latched());
}

TEST(StopTracker, AResetBeginsToCountAgain) {
  StopTracker tracker;
  tracker.take(state(9, false, ""));
  tracker.stop_asked("me");
  tracker.take(state(0, false, "", 2));
  tracker.take(state(1, true, "me", 2));
  EXPECT_TRUE(tracker.stop_latched());
}

}  // namespace
}  // namespace constrictor
