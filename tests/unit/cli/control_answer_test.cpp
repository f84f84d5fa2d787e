#include "cli/control_answer.hpp"

#include <gtest/gtest.h>

#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

msg::RunState answered(const std::string& source, std::uint64_t number, const std::string& refusal = "") {
  msg::RunState state{};
  set_text(state.control_source, source);
  state.control_sequence = number;
  set_text(state.refusal, refusal);
  return state;
}

TEST(ControlAnswer, IsThatOfThisCommandAndNoOther) {
  msg::RunControl command{};
  set_text(command.source, "control.here.1");
  command.sequence_number = 50;
  EXPECT_EQ(answer_to(command, answered("control.here.1", 50)), ControlAnswer::kObeyed);
  EXPECT_EQ(answer_to(command, answered("control.here.1", 50, "reset: no")), ControlAnswer::kRefused);
  EXPECT_EQ(answer_to(command, answered("control.here.1", 49)), ControlAnswer::kNone);
  EXPECT_EQ(answer_to(command, answered("control.here.1", 51)), ControlAnswer::kOvertaken);
  EXPECT_EQ(answer_to(command, answered("control.here.2", 51, "no")), ControlAnswer::kNone);
  EXPECT_EQ(answer_to(command, msg::RunState{}), ControlAnswer::kNone);
}

// Wall times of RunStates, as of a run that makes a tick every second and is then held up.
TEST(ControlAnswer, TicksProlongOnlyTheWaitForTicks) {
  const WaitBound::Time start{};
  WaitBound answer(WaitBound::For::kAnswer, 10s, start);
  WaitBound ticks(WaitBound::For::kTicks, 10s, start);
  EXPECT_EQ(ticks.next_tick(), -1);
  for (int second = 1; second <= 30; ++second) {
    answer.heard(second, start + second * 1s);
    ticks.heard(second, start + second * 1s);
    EXPECT_EQ(answer.over(start + second * 1s), second > 10) << second;
    EXPECT_FALSE(ticks.over(start + second * 1s)) << second;
  }
  for (int second = 31; second <= 45; ++second) {
    ticks.heard(30, start + second * 1s);  // it says how it is, and makes no tick
    EXPECT_EQ(ticks.over(start + second * 1s), second > 40) << second;
  }
  EXPECT_EQ(ticks.next_tick(), 30);
}

}  // namespace
}  // namespace constrictor::cli
