// The file of checkpoints: it always contains a complete one, however the process that writes it ends.
#include "runtime/checkpoint_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <deque>
#include <fstream>
#include <random>

#include "runtime/hash_log.hpp"
#include "support/small_disk.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

Blob blob_of(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

/// A made-up run, which makes the checkpoints 1, 2, 3 and so on. Each checkpoint has the newest eight blobs, of various
/// sizes, as the conductor keeps the last samples of a topic, and one blob that never changes. All bytes of a
/// checkpoint follow from its number.
class MadeUpRun {
 public:
  const Checkpoint& next() {
    ++number_;
    blobs_.push_back(content_of(number_));
    if (blobs_.size() > 8) blobs_.pop_front();
    checkpoint_ = {std::to_string(number_), {blobs_.begin(), blobs_.end()}};
    checkpoint_.blobs.push_back(forever_);
    return checkpoint_;
  }
  /// Empty if the checkpoint is one of this run, else what is wrong.
  static std::string fault(const Checkpoint& found) {
    const int number = std::stoi(found.head);
    const int count = std::min(number, 8);
    if (found.blobs.size() != static_cast<std::size_t>(count) + 1) return "number of blobs";
    for (int i = 0; i < count; ++i) {
      if (*found.blobs[static_cast<std::size_t>(i)] != *content_of(number - count + 1 + i))
        return "blob of " + found.head;
    }
    return *found.blobs.back() == "for ever" ? "" : "blob that never changes";
  }

 private:
  static Blob content_of(int number) {
    std::mt19937 random(static_cast<unsigned>(number));
    const std::size_t size = number % 7 == 0 ? 300'000 : number % 5 == 0 ? 0 : random() % 5000;
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    return blob_of(std::move(bytes));
  }
  int number_ = 0;
  std::deque<Blob> blobs_;
  Blob forever_ = blob_of("for ever");
  Checkpoint checkpoint_;
};

class CheckpointFileTest : public ::testing::Test {
 protected:
  void write_up_to(int number) const {
    CheckpointFile file(path_);
    MadeUpRun run;
    for (int i = 0; i < number; ++i) file.write(run.next());
  }
  /// Inverts one byte of the file.
  void damage(std::streamoff at) const {
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(at);
    const char byte = static_cast<char>(~file.get());
    file.seekp(at);
    file.put(byte);
  }
  [[nodiscard]] std::string error_of_opening() const {
    try {
      CheckpointFile file(path_);
      static_cast<void>(file.read());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }
  static constexpr std::streamoff kSlots[] = {4096, 8192};  // of even and odd checkpoints
  const testing::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "checkpoint.bin";
};

TEST_F(CheckpointFileTest, ANewFileContainsNoCheckpoint) {
  CheckpointFile file(path_);
  EXPECT_FALSE(file.read());
  EXPECT_TRUE(file.of_this_boot());
}

TEST_F(CheckpointFileTest, TheNewestCheckpointIsReadAndItsSuccessorsAreStored) {
  write_up_to(40);
  MadeUpRun run;
  for (int i = 0; i < 40; ++i) run.next();
  for (int restart = 1; restart <= 5; ++restart) {
    CheckpointFile file(path_);
    const auto found = file.read();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->head, std::to_string(39 + restart));
    EXPECT_EQ(MadeUpRun::fault(*found), "");
    file.write(run.next());
  }
}

TEST_F(CheckpointFileTest, TheFileDoesNotGrowWithTheNumberOfCheckpoints) {
  write_up_to(50);
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::remove(path_);
  write_up_to(2000);
  EXPECT_LE(std::filesystem::file_size(path_), 2 * size);
}

TEST_F(CheckpointFileTest, OneDamagedSlotIsReplacedByTheOther) {
  write_up_to(41);
  damage(kSlots[1]);  // of checkpoint 41
  CheckpointFile file(path_);
  const auto found = file.read();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->head, "40");
  EXPECT_EQ(MadeUpRun::fault(*found), "");
  EXPECT_TRUE(file.one_slot_damaged());
}

TEST_F(CheckpointFileTest, TwoDamagedSlotsAreRefused) {
  write_up_to(41);
  for (const auto slot : kSlots) damage(slot + 8);
  EXPECT_NE(error_of_opening().find("both checkpoints in it are damaged"), std::string::npos) << error_of_opening();
}

// Each byte of the content counts: after damage, the file gives an older checkpoint or none, but never a wrong one.
TEST_F(CheckpointFileTest, ADamagedByteAnywhereNeverGivesAWrongCheckpoint) {
  write_up_to(41);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path_));
  int older = 0;
  for (std::streamoff at = 0; at < size; at += 977) {
    damage(at);
    try {
      CheckpointFile file(path_);
      const auto found = file.read();
      if (found) {
        ASSERT_EQ(MadeUpRun::fault(*found), "") << "byte " << at;
        older += found->head != "41";
      }
    } catch (const std::runtime_error&) {
      ++older;  // refused
    }
    damage(at);
  }
  EXPECT_GT(older, 10) << "the damage must have hit the content";
}

TEST_F(CheckpointFileTest, AWriterKilledAtAnyMomentLeavesACompleteCheckpoint) {
  constexpr int kRounds = 40;
  constexpr int kBeyond = 20;
  std::mt19937 random(20261122);
  int newest = 0;
  // On a slow machine, more rounds follow, in which the writers have more time.
  for (int round = 0; round < kRounds || (newest <= kBeyond && round < 10 * kRounds); ++round) {
    std::filesystem::remove(path_);
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
      CheckpointFile file(path_);
      MadeUpRun run;
      for (;;) file.write(run.next());
    }
    const auto longest_us = 40'000 * (1 + static_cast<unsigned>(round / kRounds));
    ::usleep(static_cast<useconds_t>(1000 + random() % longest_us));  // the kill comes at any moment of a write
    ::kill(pid, SIGKILL);
    ASSERT_EQ(::waitpid(pid, nullptr, 0), pid);
    if (!std::filesystem::exists(path_) || std::filesystem::file_size(path_) == 0) continue;
    CheckpointFile file(path_);
    const auto found = file.read();
    if (!found) continue;  // killed before the first was complete
    ASSERT_EQ(MadeUpRun::fault(*found), "");
    newest = std::max(newest, std::stoi(found->head));
  }
  EXPECT_GT(newest, kBeyond) << "the writers must have come beyond the first checkpoints";
}

TEST_F(CheckpointFileTest, AWriterKilledWhileItBeginsAnewLeavesAFileOfThisBoot) {
  std::mt19937 random(20261125);
  for (int round = 0; round < 20; ++round) {
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
      CheckpointFile file(path_);
      for (;;) file.clear();
    }
    ::usleep(static_cast<useconds_t>(5'000 + random() % 5'000));  // the kill comes at any moment
    ::kill(pid, SIGKILL);
    ASSERT_EQ(::waitpid(pid, nullptr, 0), pid);
    EXPECT_TRUE(CheckpointFile(path_).of_this_boot());
  }
}

TEST_F(CheckpointFileTest, ASecondPlantCannotWriteToTheSameFile) {
  CheckpointFile file(path_);
  EXPECT_NE(error_of_opening().find("another process of the plant has this file open"), std::string::npos)
      << error_of_opening();
}

TEST_F(CheckpointFileTest, AFileOfAnotherKindIsRefused) {
  std::ofstream(path_) << std::string(2 << 20, 'x');
  EXPECT_NE(error_of_opening().find("no checkpoint of this release"), std::string::npos) << error_of_opening();
  std::ofstream(path_) << "short";
  EXPECT_NE(error_of_opening().find("too short"), std::string::npos) << error_of_opening();
}

TEST_F(CheckpointFileTest, ACopyOnTheDiskContainsTheSame) {
  MadeUpRun run;
  for (int i = 0; i < 10; ++i) run.next();
  const auto copy = folder_.path() / "copy.bin";
  EXPECT_FALSE(CheckpointFile::read_copy(copy));
  CheckpointFile::store_copy(copy, run.next());
  CheckpointFile::store_copy(copy, run.next());
  const auto found = CheckpointFile::read_copy(copy);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->head, "12");
  EXPECT_EQ(MadeUpRun::fault(*found), "");
}

TEST_F(CheckpointFileTest, AFullDiskIsAnErrorAndNotTheEndOfTheProcess) {
  CheckpointFile file(path_);
  file.write({"small", {blob_of("x")}});
  const testing::SmallDisk disk(file.size());
  EXPECT_THROW(file.write({"large", {blob_of(std::string(3 * file.size(), 'x'))}}), std::runtime_error);
}

void log_tick(HashLog& log, std::int64_t tick) {
  const auto state = std::make_shared<msg::JointState>();
  state->header.tick = tick;
  state->header.sequence_number = static_cast<std::uint64_t>(tick) + 1;
  log.add(topics::kInfos[topics::kJointState.id], Sample{state, &state->header});
}

TEST_F(CheckpointFileTest, AHashLogOnAFullDiskSaysWhereItEnds) {
  const testing::SmallDisk disk(4000);
  HashLog log(folder_.path());
  std::string failure;
  std::int64_t tick = 0;
  for (; failure.empty() && tick < 1000; ++tick) {
    log_tick(log, tick);
    failure = log.flush();
  }
  EXPECT_NE(failure.find("hashes.bin: "), std::string::npos) << failure;
  EXPECT_EQ(HashLog::full_disk_at(folder_.path()), tick - 1);
  EXPECT_EQ(log.flush(), "") << "it is said once";
  EXPECT_GE(HashLog::read(folder_.path()).size(), static_cast<std::size_t>(tick - 1));
}

TEST_F(CheckpointFileTest, AHashLogContinuesAtTheLengthOfTheCheckpoint) {
  std::uint64_t length = 0;
  {
    HashLog log(folder_.path());
    for (std::int64_t tick = 0; tick < 10; ++tick) log_tick(log, tick);
    EXPECT_EQ(log.flush(), "");
    length = log.length();
    for (std::int64_t tick = 10; tick < 20; ++tick) log_tick(log, tick);  // after the checkpoint
  }
  {
    HashLog log(folder_.path(), length);
    for (std::int64_t tick = 10; tick < 15; ++tick) log_tick(log, tick);
  }
  const auto entries = HashLog::read(folder_.path());
  ASSERT_EQ(entries.size(), 15u);
  for (std::size_t i = 0; i < entries.size(); ++i) EXPECT_EQ(entries[i].tick, static_cast<std::int64_t>(i));
  EXPECT_FALSE(HashLog::full_disk_at(folder_.path()));
  EXPECT_THROW(HashLog(folder_.path(), 1'000'000), std::runtime_error) << "shorter than at the checkpoint";
}

}  // namespace
}  // namespace constrictor
