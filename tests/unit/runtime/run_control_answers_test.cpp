#include "runtime/run_control_answers.hpp"

#include <gtest/gtest.h>

#include "constrictor/text.hpp"

namespace constrictor {
namespace {

msg::RunControl command(const std::string& source, std::uint64_t number) {
  msg::RunControl result{};
  set_text(result.source, source);
  result.sequence_number = number;
  return result;
}

msg::RunControlAnswer answer(const std::string& source, std::uint64_t number, const std::string& refusal = "") {
  msg::RunControlAnswer result{};
  set_text(result.source, source);
  result.sequence_number = number;
  set_text(result.refusal, refusal);
  return result;
}

TEST(RunControlAnswers, ARepeatedCommandGetsItsFirstAnswerAgain) {
  RunControlAnswers answers;
  EXPECT_EQ(answers.given(command("a", 5)), nullptr);
  answers.keep(answer("a", 5, "reset: no"));
  ASSERT_NE(answers.given(command("a", 5)), nullptr);
  EXPECT_STREQ(answers.given(command("a", 5))->refusal, "reset: no");
  EXPECT_EQ(answers.given(command("a", 4)), nullptr);
  EXPECT_EQ(answers.given(command("a", 6)), nullptr);
  EXPECT_EQ(answers.given(command("b", 5)), nullptr) << "each source has its own numbers";
}

TEST(RunControlAnswers, TheNewestNumberOfASourceNeverFalls) {
  RunControlAnswers answers;
  EXPECT_EQ(answers.newest("a"), 0u);
  answers.keep(answer("a", 5));
  answers.keep(answer("a", 4));
  EXPECT_EQ(answers.newest("a"), 5u);
  EXPECT_EQ(answers.newest("b"), 0u);
}

TEST(RunControlAnswers, ANewSourceReplacesTheOneWhoseLastAnswerIsTheOldest) {
  RunControlAnswers answers;
  const auto name = [](std::size_t i) { return "source" + std::to_string(i); };
  for (std::size_t i = 0; i < RunControlAnswers::kMost; ++i) answers.keep(answer(name(i), 9));
  answers.keep(answer(name(0), 10));
  answers.keep(answer("newcomer", 1));
  EXPECT_EQ(answers.newest("newcomer"), 1u);
  EXPECT_EQ(answers.newest(name(0)), 10u);
  EXPECT_EQ(answers.newest(name(1)), 0u) << "its last command is the oldest, so it is forgotten";
  EXPECT_EQ(answers.newest(name(2)), 9u);
}

}  // namespace
}  // namespace constrictor
