// Journals after a restart, and files that are replaced as a whole.
#include "sim/report/files.hpp"

#include <gtest/gtest.h>

#include "support/small_disk.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::report {
namespace {

TEST(Journal, RestartRemovesLinesAfterTheCheckpoint) {
  const testing::TemporaryFolder folder;
  std::uint64_t checkpoint = 0;
  {
    Journal journal(folder.path() / "deep" / "a.csv");
    journal.append("one\n", checkpoint);
    std::uint64_t length = checkpoint;
    journal.append("lost with the process\n", length);
  }
  Journal restarted(folder.path() / "deep" / "a.csv");
  restarted.append("two\n", checkpoint);
  EXPECT_EQ(folder.contents().at("deep/a.csv"), "one\ntwo\n");
  EXPECT_EQ(restarted.read(checkpoint), "one\ntwo\n");
  EXPECT_EQ(restarted.read(4), "one\n");
}

TEST(Journal, NewRunEmptiesAnOldFile) {
  const testing::TemporaryFolder folder;
  replace_file(folder.path() / "a.csv", "from yesterday");
  std::uint64_t length = 0;
  Journal(folder.path() / "a.csv").append("x", length);
  EXPECT_EQ(folder.contents().at("a.csv"), "x");
}

TEST(Journal, ReportsAFileThatWasCutOrRemoved) {
  const testing::TemporaryFolder folder;
  std::uint64_t length = 10;
  Journal journal(folder.path() / "a.csv");
  EXPECT_THROW(journal.append("x", length), std::runtime_error);
  EXPECT_THROW((void)journal.read(10), std::runtime_error);
}

// A limit of the size of files stands for a disk without space: a line is written in part, and then no more.
TEST(Journal, EndsAtItsLastWholeLineIfTheDiskIsFull) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.csv";
  std::uint64_t length = 0;
  {
    Journal journal(file);
    {
      const testing::SmallDisk disk(10);
      journal.append("the 1st\n", length);
      EXPECT_THROW(journal.append("the 2nd\n", length), NotWritten);
      journal.append("the 3rd\n", length);  // would leave a gap
    }
    journal.append("the 4th\n", length);
  }
  EXPECT_EQ(length, 8U);
  Journal restarted(file);
  EXPECT_EQ(restarted.read(length), "the 1st\n");
  restarted.append("the 5th\n", length);
  EXPECT_EQ(folder.contents().at("a.csv"), "the 1st\nthe 5th\n");
}

TEST(Journal, DiscardsLinesWithoutAPath) {
  std::uint64_t length = 0;
  Journal journal{std::filesystem::path()};
  journal.append("x", length);
  EXPECT_EQ(length, 0U);
  EXPECT_EQ(journal.read(0), "");
}

TEST(ReplaceFile, LeavesNothingBesideIt) {
  const testing::TemporaryFolder folder;
  replace_file(folder.path() / "b" / "c.json", "old");
  replace_file(folder.path() / "b" / "c.json", "new");
  const auto contents = folder.contents();
  EXPECT_EQ(contents.size(), 1U);
  EXPECT_EQ(contents.at("b/c.json"), "new");
}

TEST(LostFiles, AreNamedOnceAndTheRunGoesOn) {
  const testing::TemporaryFolder folder;
  replace_file(folder.path() / "b", "a file where a folder is needed");
  LostFiles lost(Log("report"));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(lost.attempt([&] { replace_file(folder.path() / "b" / "c.png", "x"); }));
  EXPECT_TRUE(lost.attempt([&] { replace_file(folder.path() / "d.png", "x"); }));
  ASSERT_EQ(lost.reasons().size(), 1U);
  EXPECT_EQ(lost.reasons().begin()->second,
            "cannot write " + (folder.path() / "b/c.png").string() + ": Not a directory");
}

}  // namespace
}  // namespace constrictor::report
