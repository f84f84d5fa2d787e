// Requests for tasks with missing parameters: they are refused before they take authority.
#include "component/task_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "constrictor/constants.hpp"
#include "input/arbiter.hpp"
#include "requests.hpp"

namespace constrictor {
namespace {

struct TaskParametersTest : public ::testing::Test {
  msg::TaskParameters parameters{};
  msg::Path path{};
  [[nodiscard]] std::string refusal(std::uint8_t task) const { return task_parameter_refusal(task, parameters, path); }
  [[nodiscard]] bool accepts(std::uint8_t task) const { return refusal(task).empty(); }
};

TEST_F(TaskParametersTest, EachTaskNeedsItsOwnParameters) {
  EXPECT_NE(refusal(msg::kTaskFollowLine).find("follow_line needs a line colour"), std::string::npos);
  parameters.line_colour = msg::kColourBlue;
  EXPECT_TRUE(accepts(msg::kTaskFollowLine));
  for (const auto task : {msg::kTaskSearchObject, msg::kTaskTrackObject, msg::kTaskPregrasp}) {
    EXPECT_NE(refusal(task).find("needs an object colour"), std::string::npos) << refusal(task);
  }
  EXPECT_TRUE(accepts(msg::kTaskGrasp)) << "grasp takes the pregrasped object";
  parameters.object_colour = msg::kColourGreen;
  for (const auto task : {msg::kTaskSearchObject, msg::kTaskTrackObject, msg::kTaskPregrasp}) {
    EXPECT_TRUE(accepts(task)) << refusal(task);
  }
  EXPECT_NE(refusal(msg::kTaskDrop).find("drop needs a drop zone colour"), std::string::npos);
  parameters.drop_zone_colour = msg::kColourRed;
  EXPECT_TRUE(accepts(msg::kTaskDrop));
}

// The forms that programs make of task_parameters_of() and the refusals must not differ.
TEST_F(TaskParametersTest, EachNamedValueIsAcceptedAndNoneCanBeLeftOutThatIsNotOptional) {
  int values = 0;
  for (std::uint8_t task = msg::kTaskNone + 1; task < msg::kTaskCount; ++task) {
    const auto needs = task_parameters_of(task);
    const auto set = [&](const TaskParameter& need, const std::string& value) {
      if (need.name == "line_colour") parameters.line_colour = *value_of(constants::kColour, value);
      if (need.name == "object_colour") parameters.object_colour = *value_of(constants::kColour, value);
      if (need.name == "drop_zone_colour") parameters.drop_zone_colour = *value_of(constants::kColour, value);
      if (need.name == "direction") parameters.direction = *value_of(constants::kDirection, value);
      if (need.name != "path") return;
      path.point_count = 2;
      path.x_m[1] = 1.0;
    };
    parameters = {};
    path = {};
    for (const auto& need : needs) {
      if (!need.optional) set(need, need.values.empty() ? "" : need.values.front());
    }
    EXPECT_TRUE(accepts(task)) << refusal(task);
    for (const auto& need : needs) {
      for (const auto& value : need.values) {
        set(need, value);
        EXPECT_TRUE(accepts(task)) << value << ": " << refusal(task);
        ++values;
      }
    }
    for (const auto& left_out : needs) {
      parameters = {};
      path = {};
      for (const auto& need : needs) {
        if (need.name != left_out.name) set(need, need.values.empty() ? "" : need.values.front());
      }
      EXPECT_EQ(accepts(task), left_out.optional) << left_out.name;
    }
  }
  EXPECT_EQ(values, 5 * (msg::kColourCount - 1) + 2 + 2 + (msg::kDirectionCount - 1));
}

TEST_F(TaskParametersTest, RotateTurnsLeftOrRightOnlyAndExploreAlsoForwardsAndBackwards) {
  EXPECT_FALSE(accepts(msg::kTaskRotate));
  EXPECT_FALSE(accepts(msg::kTaskExplore));
  for (const auto direction : {msg::kDirectionLeft, msg::kDirectionRight}) {
    parameters.direction = direction;
    EXPECT_TRUE(accepts(msg::kTaskRotate) && accepts(msg::kTaskExplore));
  }
  for (const auto direction : {msg::kDirectionForwards, msg::kDirectionBackwards}) {
    parameters.direction = direction;
    EXPECT_FALSE(accepts(msg::kTaskRotate));
    EXPECT_TRUE(accepts(msg::kTaskExplore));
  }
  parameters.direction = msg::kDirectionCount;
  EXPECT_FALSE(accepts(msg::kTaskRotate) || accepts(msg::kTaskExplore));
}

TEST_F(TaskParametersTest, FollowPathNeedsDifferentFinitePoints) {
  EXPECT_FALSE(accepts(msg::kTaskFollowPath));
  path.point_count = 1;
  EXPECT_FALSE(accepts(msg::kTaskFollowPath));
  path.point_count = 3;
  path.x_m[1] = path.x_m[2] = 1.0;
  EXPECT_NE(refusal(msg::kTaskFollowPath).find("point 3"), std::string::npos) << refusal(msg::kTaskFollowPath);
  path.y_m[2] = 0.5;
  EXPECT_TRUE(accepts(msg::kTaskFollowPath));
  path.y_m[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(accepts(msg::kTaskFollowPath));
  path.point_count = msg::kMaxPathPoints + 1;
  EXPECT_FALSE(accepts(msg::kTaskFollowPath));
}

TEST_F(TaskParametersTest, APathOf2To64PointsBelongsToFollowPathOnly) {
  EXPECT_EQ(path_refusal(msg::kTaskRotate, path), "");
  EXPECT_EQ(path_refusal(msg::kTaskFollowPath, path), "follow_path needs a path: found 0 points, accepted 2 to 64");
  path.point_count = 2;
  path.x_m[1] = 1.0;
  EXPECT_EQ(path_refusal(msg::kTaskFollowPath, path), "");
  EXPECT_EQ(path_refusal(msg::kTaskRotate, path), "path: accepted with follow_path only");
  parameters.direction = msg::kDirectionLeft;
  EXPECT_TRUE(accepts(msg::kTaskRotate)) << "`input` ignores a path that no task follows";
  EXPECT_EQ(path_size_refusal(1), "found 1 point, accepted 2 to 64");
  EXPECT_EQ(path_size_refusal(2), "");
  EXPECT_EQ(path_size_refusal(64), "");
  EXPECT_NE(path_size_refusal(65), "");
}

TEST_F(TaskParametersTest, UnknownTasksAreRefused) {
  EXPECT_FALSE(accepts(msg::kTaskNone));
  EXPECT_FALSE(accepts(msg::kTaskCount));
}

TEST(Arbiter, RefusesATaskWithoutItsParametersBeforeItTakesAuthority) {
  ArbiterState state;
  Arbiter arbiter(state);
  const auto running = arbiter.decide_planner(request("planner", kPlanner, msg::kRequestTask, 1, 1));
  ASSERT_EQ(running.kind, Decision::kForward);
  auto rotate = request("pilot", kOperator, msg::kRequestTask, 1, 0);
  rotate.task = msg::kTaskRotate;
  EXPECT_EQ(arbiter.decide_client(rotate).kind, Decision::kRefused);
  EXPECT_NE(state.refusal.find("rotate needs a direction"), std::string::npos) << state.refusal;
  EXPECT_EQ(state.holder, "planner") << "the mission continues";
  EXPECT_EQ(state.level, kPlanner);
  // The refused request has not used up a goal id.
  rotate.header.sequence_number = 2;
  rotate.goal_id = 1;
  rotate.parameters.direction = msg::kDirectionLeft;
  EXPECT_EQ(arbiter.decide_client(rotate).kind, Decision::kForward);
  EXPECT_EQ(state.holder, "pilot");
}

}  // namespace
}  // namespace constrictor
