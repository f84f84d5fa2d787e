// tests/bench/commits/measure.py, which scripts/compare_commits.sh calls, with shell scripts instead of two builds.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class CompareCommits : public ::testing::Test {
 protected:
  /// A program that takes turns with another one in the file `turns`, and writes a report of 10 simulated seconds.
  fs::path program(const std::string& name, const std::string& factor, const std::string& processes,
                   const std::string& before = "") {
    fs::path file = dir_.path() / name;
    std::ofstream(file) << "#!/bin/sh\n"
                        << "while [ $# -gt 1 ]; do [ $1 = --report ] && folder=$2; shift; done\n"
                        << "echo " << name << " >> " << (dir_.path() / "turns").string() << "\n"
                        << before << "\nmkdir -p $folder\n"
                        << "echo '{\"sim_time_s\": 10, \"success\": true, \"real_time_factor\": " << factor
                        << ", \"processes\": [" << processes << "]}' > $folder/report.json\n";
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }
  [[nodiscard]] Process compare(const fs::path& before, const fs::path& after, std::vector<std::string> options) const {
    std::vector<std::string> words{"/usr/bin/python3",
                                   source_path("tests/bench/commits/measure.py").string(),
                                   "--old",
                                   before.string(),
                                   "--new",
                                   after.string(),
                                   "--names",
                                   "old",
                                   "new",
                                   "--output",
                                   (dir_.path() / "out").string()};
    words.insert(words.end(), options.begin(), options.end());
    return Process(words);
  }
  [[nodiscard]] std::string text(const fs::path& file) const {
    std::ifstream stream(dir_.path() / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  TemporaryFolder dir_;
};

TEST_F(CompareCommits, TheTwoTakeTurnsAndTheRatioIsThatOfTheMedians) {
  const auto before = program("before", "4.0", R"({"name": "physics", "cpu_s": 3.0, "max_pss_mib": 20})");
  const auto after = program("after", "10.0",
                             R"({"name": "physics", "cpu_s": 1.0, "max_pss_mib": 30},)"
                             R"( {"name": "report", "cpu_s": 0.5, "max_pss_mib": 5})");
  Process run = compare(before, after, {"--runs", "2", "--conditions", "loaded"});
  ASSERT_EQ(run.wait(60s), 0) << run.output() << run.errors();
  EXPECT_EQ(text("turns"), "before\nafter\nbefore\nafter\n");
  const std::string table = text("out/comparison.md");
  EXPECT_NE(table.find("| 4.00, 4.00 | 10.00, 10.00 | 2.50 | 300, 300 | 150, 150 | 0.50 |"), std::string::npos)
      << table;
  EXPECT_NE(table.find("| `physics` | 300.0 | 100.0 | 0.33 | 20.0 | 30.0 |"), std::string::npos) << table;
  EXPECT_NE(table.find("| `report` |  | 50.0 |  |  | 5.0 |"), std::string::npos) << table;
}

TEST_F(CompareCommits, ARunWithoutAReportIsNamedWithWhatItSaid) {
  const auto before = program("before", "4.0", "");
  const auto after = program("after", "4.0", "", "echo there is no engine; exit 1");
  Process run = compare(before, after, {"--runs", "1", "--conditions", "quiet"});
  ASSERT_EQ(run.wait(60s), 1);
  EXPECT_NE(run.errors().find("out/quiet_1_new/report/report.json"), std::string::npos) << run.errors();
  EXPECT_NE(run.errors().find("there is no engine"), std::string::npos) << run.errors();
}

TEST_F(CompareCommits, TheReportOfAnEarlierCallIsNotTakenForThatOfARun) {
  const auto good = program("before", "4.0", R"({"name": "physics", "cpu_s": 3.0, "max_pss_mib": 20})");
  Process first = compare(good, good, {"--runs", "1", "--conditions", "quiet"});
  ASSERT_EQ(first.wait(60s), 0) << first.errors();
  const auto refused = program("after", "4.0", "", "echo there is no scenario; exit 64");
  Process second = compare(good, refused, {"--runs", "1", "--conditions", "quiet"});
  EXPECT_EQ(second.wait(60s), 1);
  EXPECT_NE(second.errors().find("there is no scenario"), std::string::npos) << second.errors();
}

TEST_F(CompareCommits, WrongOptionsAreRefusedBeforeARun) {
  const auto fake = program("before", "4.0", "");
  Process condition = compare(fake, fake, {"--conditions", "fast"});
  EXPECT_EQ(condition.wait(60s), 64);
  EXPECT_NE(condition.errors().find("found 'fast', accepted one or more of quiet,loaded,one_core"), std::string::npos)
      << condition.errors();
  Process runs = compare(fake, fake, {"--runs", "0"});
  EXPECT_EQ(runs.wait(60s), 64);
  EXPECT_EQ(text("turns"), "");
}

TEST_F(CompareCommits, CtrlCEndsTheRunThatIsGoingOn) {
  const auto fake = program("before", "4.0", "",
                            "trap 'echo ended >> $folder.log; exit 130' INT; mkdir -p $folder\n"
                            "echo begun; for i in $(seq 600); do sleep 0.1; done");
  Process run = compare(fake, fake, {"--runs", "1", "--conditions", "quiet"});
  ASSERT_TRUE(eventually([&] { return text("out/quiet_1_old/output.txt").find("begun") != std::string::npos; }, 30s));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(30s), 130);
  EXPECT_EQ(text("out/quiet_1_old/report.log"), "ended\n");
}

}  // namespace
}  // namespace constrictor::testing
