// The perception study: its table of errors, the results of evaluations, and what the curves show of them.
#include "bench/perception_study/study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "bench/perception_study/plot.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::perception_study {
namespace {

class Study : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name) << text;
  }
  [[nodiscard]] std::vector<Factor> factors(const std::string& table) const {
    write("factors.yaml", table);
    return read_factors(folder_.path() / "factors.yaml");
  }
  [[nodiscard]] std::string refusal(const std::string& table) const {
    try {
      static_cast<void>(factors(table));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  }
  /// An evaluation with a variant for each pair of runs and successes.
  void write_evaluation(const std::string& name, const std::vector<std::pair<int, int>>& variants) const {
    std::string text = R"({"variants": [)";
    for (const auto& [runs, successes] : variants) {
      if (text.back() == '}') text += ", ";
      const std::string time = successes > 0 ? R"({"p25": 190, "median": 200, "p75": 220})"
                                             : R"({"p25": null, "median": null, "p75": null})";
      text += R"({"runs": )" + std::to_string(runs) + R"(, "errors": 0, "false_successes": 1, )" +
              R"("phases": {"mission succeeded": {"runs": )" + std::to_string(successes) +
              R"(, "wilson_95": [0.25, 0.75]}}, "placement_m": {"p25": 0.05, "median": 0.07, "p75": 0.1}, )" +
              R"("mission_time_s": )" + time + "}";
    }
    write(name + "/summary.json", text + "]}");
  }
  const testing::TemporaryFolder folder_;
};

constexpr const char* kTable = R"(factors:
  - {name: blur, title: Blur of the image, axis: pixels, reference: 0, levels: [1, 2.5],
     vary: [camera:error.blur_pixels=@, noise.camera_sd=0]}
  - {name: bias, title: Range, axis: factor, reference: 1, levels: [0.8, 1.2],
     vary: ["perception:error.range_factor=@"]}
)";

TEST_F(Study, ReadsLevelsAndSettings) {
  const auto all = factors(kTable);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].title, "Blur of the image");
  EXPECT_EQ(all[0].levels, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(all[0].settings, (std::vector<std::string>{"camera:error.blur_pixels=1,2.5", "noise.camera_sd=0"}));
  EXPECT_EQ(all[1].reference, 1.0);
}

TEST_F(Study, NamesTheLineAndTheMistakeOfAFile) {
  const auto expect = [&](const std::string& what, const std::string& with, const std::string& reason) {
    std::string table = kTable;
    table.replace(table.find(what), what.size(), with);
    EXPECT_NE(refusal(table).find(reason), std::string::npos) << refusal(table);
  };
  expect("axis: pixels, ", "", "factors.yaml:2: factors[0].axis: found nothing");
  expect("reference: 0", "reference: none", "reference: found none");
  expect("2.5]", "x]", "levels");
  expect("[1, 2.5]", "[]", "levels");
  expect("name: blur", "name: ../x", "name: found '../x'");
  expect("name: blur", "name: reference", "name: found 'reference'");
  expect("name: bias", "name: blur", "name: found 'blur' a second time");
  expect("[camera:error.blur_pixels=@, noise.camera_sd=0]", "[]", "vary: found nothing");
  expect("title: Range", "colour: red, title: Range", "colour");
}

TEST_F(Study, TheShippedTableIsInOrder) {
  for (const auto& factor : read_factors(testing::source_path("tests/bench/perception_study/factors.yaml"))) {
    EXPECT_TRUE(std::is_sorted(factor.levels.begin(), factor.levels.end()) ||
                std::is_sorted(factor.levels.rbegin(), factor.levels.rend()))
        << factor.name;
    EXPECT_EQ(std::count(factor.levels.begin(), factor.levels.end(), factor.reference), 0) << factor.name;
  }
}

TEST_F(Study, PutsTheRunsWithoutErrorsAmongTheLevelsAndLeavesOutWhatWasNotDone) {
  write_evaluation("reference", {{5, 5}});
  write_evaluation("bias", {{4, 1}, {3, 0}});
  write_evaluation("blur", {{2, 2}, {0, 0}});
  const auto all = factors(kTable);
  const auto bias = read_results(folder_.path(), all[1]), blur = read_results(folder_.path(), all[0]);
  ASSERT_EQ(bias.size(), 3u);
  EXPECT_EQ(bias[0].level, 0.8);
  EXPECT_EQ(bias[0].successes, 1u);
  EXPECT_EQ(bias[0].wilson_high, 0.75);
  EXPECT_TRUE(bias[1].reference && bias[1].level == 1.0 && bias[1].runs == 5);
  EXPECT_TRUE(std::isnan(bias[2].time_s.median));
  EXPECT_EQ(bias[2].placement_m.median, 0.07);
  ASSERT_EQ(blur.size(), 2u);
  EXPECT_EQ(blur[1].level, 1.0);
  EXPECT_TRUE(read_results(folder_.path(), Factor{"none", "", "", 0, {1}, {}}).empty());

  EXPECT_NE(
      to_csv(all, {blur, bias}).find("\r\nbias,0.8,0,4,1,0.2500,0.7500,1,0,0.0500,0.0700,0.1000,190.0,200.0,220.0\r\n"),
      std::string::npos);
  EXPECT_NE(to_csv(all, {blur, bias}).find("\r\nbias,1.2,0,3,0,0.2500,0.7500,1,0,0.0500,0.0700,0.1000,,,\r\n"),
            std::string::npos);
  EXPECT_NE(to_markdown(all, {blur, bias}).find("| Range, factor | 1 (none) | 5 of 5 | 25 to 75 % |"),
            std::string::npos);
}

TEST_F(Study, RefusesAnEvaluationOfOtherLevelsAndADamagedOne) {
  const auto all = factors(kTable);
  write_evaluation("bias", {{4, 1}});
  EXPECT_THROW(static_cast<void>(read_results(folder_.path(), all[1])), std::runtime_error);
  write("bias/summary.json", R"({"variants": [{}, {}]})");
  EXPECT_THROW(static_cast<void>(read_results(folder_.path(), all[1])), std::runtime_error);
  write("bias/summary.json", R"({"variants": [)");
  EXPECT_THROW(static_cast<void>(read_results(folder_.path(), all[1])), std::runtime_error);
}

TEST_F(Study, DrawsAPanelForEachErrorThatHasResults) {
  write_evaluation("reference", {{5, 5}});
  write_evaluation("bias", {{4, 1}, {3, 0}});
  const auto all = factors(kTable);
  const std::string svg = draw(figure::Format::kSvg, "A title", all,
                               {read_results(folder_.path(), all[0]), read_results(folder_.path(), all[1])});
  for (const char* text : {"A title", "Range", "factor", "n = 4", "none", "0.8", "missions that succeed [%]"})
    EXPECT_NE(svg.find(std::string(">") + text), std::string::npos) << text;
  EXPECT_EQ(svg.find("Blur of the image"), std::string::npos);
  EXPECT_FALSE(draw(figure::Format::kPng, "Nothing", all, {{}, {}}).empty());
}

}  // namespace
}  // namespace constrictor::perception_study
