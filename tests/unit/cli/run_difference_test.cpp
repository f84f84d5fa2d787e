#include "cli/run_difference.hpp"

#include <gtest/gtest.h>

#include "constrictor/reflect.hpp"
#include "constrictor/topics.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using Log = std::vector<HashLog::Entry>;

/// The hash log of a run of `ticks` ticks in which physics writes joint_state and control writes joint_command.
Log run_of(std::int64_t ticks) {
  Log log;
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const auto number = static_cast<std::uint64_t>(tick) + 1;
    log.push_back({tick, number, topics::kJointState.id, 100 + number, ""});
    log.push_back({tick, number, topics::kJointCommand.id, 200 + number, ""});
  }
  return log;
}

HashLog::Entry& command_at(Log& log, std::int64_t tick) { return log[static_cast<std::size_t>(2 * tick + 1)]; }

TEST(RunDifference, EqualRunsHaveNoDifference) { EXPECT_FALSE(first_run_difference(run_of(100), run_of(100))); }

TEST(RunDifference, NamesTickComponentAndTopicOfTheFirstDifference) {
  Log changed = run_of(100);
  command_at(changed, 60).hash ^= 1;
  command_at(changed, 40).hash ^= 1;
  const auto difference = first_run_difference(run_of(100), changed);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->tick, 40);
  EXPECT_EQ(difference->component, "control");
  EXPECT_EQ(difference->topic, "joint_command");
  EXPECT_TRUE(difference->field.empty());
}

TEST(RunDifference, NamesTheFieldIfMessagesWereRecorded) {
  msg::JointCommand command{};
  command.position_rad[3] = 0.5;
  Log a = run_of(100);
  Log b = run_of(100);
  canonical_bytes(command, command_at(a, 7).bytes);
  command.position_rad[3] = 0.25;
  canonical_bytes(command, command_at(b, 7).bytes);
  command_at(b, 7).hash ^= 1;
  const auto difference = first_run_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "position_rad[3]");
  EXPECT_EQ(difference->a, "0.5");
  EXPECT_EQ(difference->b, "0.25");
}

TEST(RunDifference, AMissingMessageIsADifferenceExceptAtTheEndOfTheLog) {
  Log lacks = run_of(100);
  lacks.erase(lacks.begin() + 2 * 30 + 1);
  const auto difference = first_run_difference(run_of(100), lacks);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->tick, 30);
  EXPECT_EQ(difference->b, "no message");
  Log lacks_last = run_of(100);
  lacks_last.pop_back();
  EXPECT_FALSE(first_run_difference(run_of(100), lacks_last));
  EXPECT_FALSE(first_run_difference(lacks_last, run_of(100)));
}

TEST(RunDifference, AShorterRunDiffersAtItsEnd) {
  const auto difference = first_run_difference(run_of(100), run_of(90));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->tick, 89);
  EXPECT_EQ(difference->a, "ends at tick 99");
  EXPECT_EQ(difference->b, "ends at tick 89");
}

TEST(RunDifference, AStepThatARestartedMemberRepeatsIsNoDifference) {
  Log twice = run_of(100);
  twice.insert(twice.begin() + 2 * 50 + 1, command_at(twice, 50));
  EXPECT_FALSE(first_run_difference(run_of(100), twice));
}

/// Writes report directories that contain a hash log.
class RunDifferenceOfFiles : public ::testing::Test {
 protected:
  std::filesystem::path log_of(const std::string& name, int ticks) const {
    HashLog log(folder_.path() / name);
    for (int tick = 0; tick < ticks; ++tick) {
      const auto state = std::make_shared<msg::JointState>();
      state->header.tick = tick;
      state->header.sequence_number = static_cast<std::uint64_t>(tick) + 1;
      log.add(topics::kInfos[topics::kJointState.id], Sample{state, &state->header});
    }
    return folder_.path() / name;
  }
  const testing::TemporaryFolder folder_;
};

TEST_F(RunDifferenceOfFiles, ARunWithoutTicksCannotBeCompared) {
  EXPECT_FALSE(compare_runs(log_of("a", 3), log_of("b", 3)));
  const std::filesystem::path empty = log_of("empty", 0);
  for (const auto& [one, other] :
       {std::pair(empty, empty), std::pair(empty, log_of("a", 3)), std::pair(log_of("a", 3), empty)}) {
    try {
      compare_runs(one, other);
      FAIL() << one << " and " << other;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("empty/hashes.bin: contains no tick"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace constrictor::cli
