// Requests of ROS programs by lines of text: what is accepted, and which answers follow.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "constrictor/text.hpp"
#include "ros_bridge/task_desk.hpp"

namespace constrictor::ros_bridge {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

TEST(RosTaskLine, IsATaskWithParametersOrAWord) {
  const auto parsed = parse_task_line("rotate direction=left timeout_s=5");
  ASSERT_TRUE(std::holds_alternative<TaskLine>(parsed)) << std::get<std::string>(parsed);
  const msg::Request& request = std::get<TaskLine>(parsed).request;
  EXPECT_EQ(request.kind, msg::kRequestTask);
  EXPECT_EQ(request.command, msg::kCommandStart);
  EXPECT_EQ(request.task, msg::kTaskRotate);
  EXPECT_EQ(request.parameters.direction, msg::kDirectionLeft);
  EXPECT_EQ(request.parameters.timeout_s, 5);
  EXPECT_EQ(std::get<TaskLine>(parse_task_line("cancel")).kind, TaskLine::Kind::kCancel);
  EXPECT_EQ(std::get<TaskLine>(parse_task_line("take")).kind, TaskLine::Kind::kTake);
  EXPECT_EQ(std::get<TaskLine>(parse_task_line("release")).kind, TaskLine::Kind::kRelease);
}

TEST(RosTaskLine, IsRefusedWithWhatWasFoundAndWhatIsAccepted) {
  for (const auto& [line, said] :
       std::initializer_list<std::pair<std::string, std::string>>{{"", "follow_line"},
                                                                  {"dance", "found 'dance'"},
                                                                  {"follow_line", "follow_line needs a line colour"},
                                                                  {"follow_line line_colour=pink", "found 'pink'"},
                                                                  {"follow_line colour", "NAME=VALUE"},
                                                                  {"rotate direction=left timeout_s=1e9", "3600"},
                                                                  {"follow_path path=0,0", "accepted 2 to"},
                                                                  {"cancel now", "found 'cancel'"},
                                                                  {"\x1b[2J", "found '?[2J'"},
                                                                  {std::string(5000, 'x'), "found 5000 characters"}}) {
    const auto parsed = parse_task_line(line);
    ASSERT_TRUE(std::holds_alternative<std::string>(parsed)) << line;
    EXPECT_NE(std::get<std::string>(parsed).find(said), std::string::npos) << std::get<std::string>(parsed);
  }
}

class RosTaskDesk : public ::testing::Test {
 protected:
  void send(const std::string& line, std::uint64_t number) {
    desk_.sent(line, std::get<TaskLine>(parse_task_line(line)), number, now_);
  }
  void answer(std::uint64_t number, bool granted, std::uint64_t goal = 0, const std::string& reason = {}) {
    msg::RequestAnswer answer{};
    answer.request_sequence = number;
    answer.granted = granted;
    answer.goal_id = goal;
    set_text(answer.reason, reason);
    desk_.answered(answer);
  }
  void event(std::uint64_t goal, std::uint8_t state, const std::string& detail = {}, std::uint32_t epoch = 1) {
    msg::TaskEvent event{};
    event.header.run_id = 1;
    event.header.epoch = epoch;
    event.header.sequence_number = ++sequence_;
    event.goal_id = goal;
    event.goal_state = state;
    set_text(event.detail, detail);
    goals_.take(event);
  }
  /// The states of the answers since the last call, joined; and the last answer in last_.
  std::string states() {
    desk_.look(goals_, now_);
    std::string list;
    for (const auto& text : desk_.answers()) {
      last_ = json::parse(text);
      list += (list.empty() ? "" : " ") + last_.at("state").get<std::string>();
    }
    return list;
  }
  TaskDesk desk_;
  GoalTracker goals_;
  TaskDesk::Time now_{100s};
  std::uint64_t sequence_ = 0;
  json last_;
};

TEST_F(RosTaskDesk, AGoalIsAnsweredWhenItBeginsAndWhenItEnds) {
  send("follow_line line_colour=blue", 4);
  EXPECT_TRUE(desk_.busy());
  EXPECT_EQ(states(), "");
  answer(4, true, 77);
  EXPECT_TRUE(desk_.waiting().empty());
  EXPECT_EQ(states(), "") << "navigation has not accepted it yet";
  event(77, msg::kGoalRunning);
  EXPECT_EQ(states(), "running");
  EXPECT_EQ(last_.at("request"), "follow_line line_colour=blue");
  EXPECT_EQ(last_.at("goal"), 77);
  EXPECT_EQ(states(), "") << "nothing is said twice";
  event(77, msg::kGoalAborted, "line lost");
  EXPECT_EQ(states(), "aborted");
  EXPECT_EQ(last_.at("reason"), "line lost");
  EXPECT_FALSE(desk_.busy());
  EXPECT_EQ(desk_.refused(), 0u);
}

TEST_F(RosTaskDesk, RefusalsOfTheBridgeOfInputAndOfNavigationAreCounted) {
  desk_.refuse("dance", "found 'dance'");
  EXPECT_EQ(states(), "refused");
  send("grasp", 1);
  answer(1, false, 0, "another operator has authority");
  EXPECT_EQ(states(), "refused");
  EXPECT_EQ(last_.at("reason"), "another operator has authority");
  send("grasp", 2);
  answer(2, true, 9);
  event(9, msg::kGoalRefused, "no object was pregrasped");
  EXPECT_EQ(states(), "refused");
  EXPECT_EQ(last_.at("reason"), "no object was pregrasped");
  EXPECT_EQ(desk_.refused(), 3u);
  EXPECT_EQ(desk_.last_reason(), "no object was pregrasped");
  EXPECT_FALSE(desk_.busy());
}

TEST_F(RosTaskDesk, ARequestWithoutAnAnswerIsReportedOnceAndMayStillBeAnswered) {
  send("grasp", 1);
  now_ += 4s;
  EXPECT_EQ(states(), "");
  now_ += 2s;
  EXPECT_EQ(states(), "unanswered");
  now_ += 60s;
  EXPECT_EQ(states(), "");
  answer(1, true, 3);
  event(3, msg::kGoalRunning);
  EXPECT_EQ(states(), "running");
}

TEST_F(RosTaskDesk, TakeKeepsAuthorityUntilRelease) {
  EXPECT_FALSE(desk_.keeps_authority());
  send("take", 1);
  EXPECT_FALSE(desk_.busy());
  answer(1, true);
  EXPECT_EQ(states(), "granted");
  EXPECT_TRUE(desk_.keeps_authority());
  send("cancel", 2);
  answer(2, true);
  EXPECT_TRUE(desk_.keeps_authority());
  send("release", 3);
  answer(3, true);
  EXPECT_FALSE(desk_.keeps_authority());
}

TEST_F(RosTaskDesk, AResetEndsItsGoals) {
  send("grasp", 1);
  answer(1, true, 9);
  event(9, msg::kGoalRunning);
  EXPECT_EQ(states(), "running");
  event(1, msg::kGoalRunning, "", 2);
  EXPECT_EQ(states(), "aborted");
  EXPECT_EQ(last_.at("reason"), "the run was reset");
  EXPECT_FALSE(desk_.busy());
}

TEST(RosTaskTexts, AreJsonWithNamesInsteadOfNumbers) {
  msg::TaskStatus status{};
  status.task = msg::kTaskGrasp;
  status.goal_state = msg::kGoalRunning;
  set_text(status.phase, "seat");
  const json shown = json::parse(task_status_json(status));
  EXPECT_EQ(shown.at("task"), "grasp");
  EXPECT_EQ(shown.at("state"), "running");
  EXPECT_EQ(shown.at("phase"), "seat");
  msg::TaskEvent event{};
  event.header.time_ns = 1'500'000'000;
  event.event = msg::kEventLineLost;
  event.colour = msg::kColourBlue;
  const json told = json::parse(task_event_json(event));
  EXPECT_EQ(told.at("event"), "line_lost");
  EXPECT_EQ(told.at("colour"), "blue");
  EXPECT_EQ(told.at("time_s"), 1.5);
}

}  // namespace
}  // namespace constrictor::ros_bridge
