// The texts that users type and read for tasks, events, goals and durations.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli/task_command.hpp"
#include "cli/task_request.hpp"
#include "cli/usage.hpp"
#include "client/task_names.hpp"
#include "component/task_parameters.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

TEST(TaskNames, FindsEveryNameWithBlanksHyphensOrUnderscores) {
  for (std::uint8_t task = 1; task < msg::kTaskCount; ++task) EXPECT_EQ(task_by_name(task_word(task)), task);
  for (std::uint8_t event = 1; event < msg::kEventCount; ++event) EXPECT_EQ(event_by_name(event_name(event)), event);
  EXPECT_EQ(task_by_name("Follow-Line"), msg::kTaskFollowLine);
  EXPECT_EQ(event_by_name("line_lost"), msg::kEventLineLost);
  EXPECT_FALSE(task_by_name("none"));
  EXPECT_FALSE(event_by_name("nothing"));
}

TEST(TaskNames, ReadsATaskFromOneLineAndNamesTheProblem) {
  std::uint8_t task = 0;
  msg::TaskParameters parameters{};
  msg::Path path{};
  EXPECT_EQ(parse_task("rotate direction=left timeout_s=2.5", task, parameters, path), "");
  EXPECT_EQ(task, msg::kTaskRotate);
  EXPECT_EQ(parameters.direction, msg::kDirectionLeft);
  EXPECT_EQ(parameters.timeout_s, 2.5);
  EXPECT_EQ(parse_task("drop drop-zone-colour=red object_handle=7", task, parameters, path), "");
  EXPECT_EQ(parameters.drop_zone_colour, msg::kColourRed);
  EXPECT_EQ(parameters.object_handle, 7);
  for (const char* bad :
       {"", "fly", "rotate direction", "rotate direction=up", "rotate timeout_s=-1", "rotate timeout_s=2x",
        "rotate speed=1", "drop object_handle=70000", "follow_line line_colour=pink", "follow_path",
        "follow_path path=", "follow_path path=1,2", "follow_path path=1,2;3", "follow_path path=1,2;nan,0",
        "rotate direction=left path=0,0;1,0"}) {
    EXPECT_NE(parse_task(bad, task, parameters, path), "") << bad;
  }
  for (const auto& [wrong, meant] : {std::pair("folow_line", "follow_line"),
                                     {"rotate Lft=1", ""},
                                     {"rotate direction=lft", "left"},
                                     {"follow_line line-colour=bleu", "blue"},
                                     {"follow_line line_color=blue", "line_colour"}}) {
    const std::string problem = parse_task(wrong, task, parameters, path);
    const std::string hint = *meant ? ", did you mean '" + std::string(meant) + "'?" : "path";
    EXPECT_TRUE(problem.ends_with(hint)) << problem;
  }
  EXPECT_EQ(parse_task("follow_path path=0,0;1.5,-0.25;2,0", task, parameters, path), "");
  EXPECT_EQ(path.point_count, 3);
  EXPECT_EQ(path.x_m[1], 1.5);
  EXPECT_EQ(path.y_m[1], -0.25);
}

TEST(TaskNames, AcceptsPathsOf2To64Points) {
  msg::Path path{};
  EXPECT_EQ(set_path(path, {}), "");
  EXPECT_EQ(path.point_count, 0);
  EXPECT_EQ(set_path(path, std::vector<std::string>(64, "1,2")), "");
  EXPECT_EQ(path.point_count, 64);
  EXPECT_NE(set_path(path, std::vector<std::string>(65, "1,2")), "");
}

TEST(Durations, AcceptNumbersWithUnitsAndRejectOtherTexts) {
  EXPECT_EQ(parse_duration("--for", "5s"), 5s);
  EXPECT_EQ(parse_duration("--for", "250ms"), 250ms);
  EXPECT_EQ(parse_duration("--for", "1.5m"), 90s);
  for (const char* bad : {"", "s", "-1s", "0", "5 parsecs", "nan", "inf"})
    EXPECT_THROW(parse_duration("--for", bad), UsageError) << bad;
}

TEST(TaskRequest, AnIncompleteTaskIsRefusedBeforeItIsSent) {
  for (const char* incomplete : {"rotate", "rotate direction=forwards", "explore", "follow_line", "search_object",
                                 "track_object", "pregrasp", "drop"}) {
    msg::Request request{};
    ASSERT_EQ(parse_task(incomplete, request.task, request.parameters, request.path), "") << incomplete;
    EXPECT_NE(request_refusal(request).find("need"), std::string::npos) << incomplete;
  }
  for (const char* complete :
       {"rotate direction=left", "explore direction=forwards", "grasp", "follow_line line_colour=blue",
        "drop drop_zone_colour=red", "follow_path path=0,0;1,0"}) {
    msg::Request request{};
    ASSERT_EQ(parse_task(complete, request.task, request.parameters, request.path), "") << complete;
    EXPECT_EQ(request_refusal(request), "") << complete;
  }
}

TEST(TaskRequest, AGoalIsShownAsAShortNumberAndWithItsLevelUnlessAnOperatorStartedIt) {
  EXPECT_EQ(goal_text((std::uint64_t{msg::kAuthorityOperator} << 48) + (std::uint64_t{5} << 32) + 3), "3");
  EXPECT_EQ(goal_text((std::uint64_t{msg::kAuthorityPlanner} << 48) + 12), "12 (planner)");
}

}  // namespace
}  // namespace constrictor::cli
