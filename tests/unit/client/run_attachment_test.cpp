// A client stays with the run that it has joined and leaves when that run is gone.
#include "client/run_attachment.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

using namespace std::chrono_literals;

class Attachment : public ::testing::Test {
 protected:
  Attachment() {
    signs_.input = true;
    signs_.run_id = 77;
    signs_.states_heard = 1;
    look();
  }
  void look(std::chrono::milliseconds later = 0ms) { attachment_.look(signs_, now_ += later); }

  RunSigns signs_;
  RunAttachment::Clock::time_point now_{1h};
  RunAttachment attachment_;
};

TEST_F(Attachment, GoesOnWhileTheRunSendsItsState) {
  for (int i = 0; i < 100; ++i) {
    ++signs_.states_heard;
    look(1s);
    EXPECT_TRUE(attachment_.may_send());
    EXPECT_EQ(attachment_.silent_s(), 0.0);
  }
}

TEST_F(Attachment, LeavesWhenAnotherRunStartsInTheDomain) {
  signs_.run_id = 78;
  ++signs_.states_heard;
  look();
  EXPECT_FALSE(attachment_.may_send());
  EXPECT_EQ(attachment_.over(), "the run has ended: another one has started in its DDS domain");
  signs_.run_id = 77;  // does not come back
  look();
  EXPECT_FALSE(attachment_.may_send());
}

TEST_F(Attachment, LeavesWhenTheLauncherOrThePlantEnds) {
  RunAttachment other = attachment_;
  signs_.launcher = false;
  look();
  EXPECT_EQ(attachment_.over(), "the run has ended");
  signs_.launcher = true;
  signs_.plant_ended = true;
  other.look(signs_, now_);
  EXPECT_EQ(other.over(), "the run has ended");
  EXPECT_FALSE(other.may_send());
}

TEST_F(Attachment, SendsNothingWhileInputIsMissing) {
  signs_.input = false;
  look();
  EXPECT_FALSE(attachment_.may_send());
  EXPECT_TRUE(attachment_.may_stop()) << "a stop must be possible at any time, because it moves nothing";
  look(4s);
  EXPECT_EQ(attachment_.over(), "");
  signs_.input = true;
  look();
  EXPECT_TRUE(attachment_.may_send());
  signs_.input = false;
  look(4s);
  EXPECT_EQ(attachment_.over(), "") << "the time counts from when `input` disappeared";
  look(5s);
  EXPECT_NE(attachment_.over(), "");
  EXPECT_FALSE(attachment_.may_stop());
}

TEST_F(Attachment, ReportsHowLongTheRunIsSilent) {
  look(2500ms);
  look(2500ms);
  EXPECT_DOUBLE_EQ(attachment_.silent_s(), 5.0);
  ++signs_.states_heard;
  look(100ms);
  EXPECT_DOUBLE_EQ(attachment_.silent_s(), 0.0);
}

TEST(RunAttachment, WaitsForTheFirstRunState) {
  RunAttachment attachment;
  attachment.look({}, RunAttachment::Clock::time_point{1h});
  attachment.look({}, RunAttachment::Clock::time_point{2h});
  EXPECT_EQ(attachment.over(), "");
  EXPECT_TRUE(attachment.may_send());
  EXPECT_EQ(attachment.silent_s(), 0.0);
}

}  // namespace
}  // namespace constrictor
