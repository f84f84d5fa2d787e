// scripts/perception_study.sh with toy components: done whole, interrupted and continued, and with wrong options.
#include "integration/run_command_fixture.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

class PerceptionStudy : public RunCommand {
 protected:
  PerceptionStudy() {
    write("60_ticks.yaml", "");
    write("factors.yaml",
          "factors:\n"
          "  - {name: noise, title: Noise, axis: sd, reference: 0.01, levels: [0.1, 0.2], vary: [noise.camera_sd=@]}\n"
          "  - {name: slip, title: Slip, axis: ratio, reference: 10, levels: [2, 4],\n"
          "     vary: [\"robot:skin.friction_across=0.1,0.2\", noise.camera_sd=0.05]}\n");
  }
  [[nodiscard]] Process study(std::vector<std::string> options, const std::string& scenario = "60_ticks.yaml") const {
    std::vector<std::string> words{testing::source_path("scripts/perception_study.sh"),
                                   "--programs",
                                   fs::path(program("constrictor")).parent_path().string(),
                                   "--factors",
                                   (dir_ / "factors.yaml").string(),
                                   "--scenario",
                                   (dir_ / scenario).string(),
                                   "--output",
                                   (dir_ / "study").string(),
                                   "--jobs",
                                   "2"};
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--", "--manifest", (dir_ / "toys.yaml").string()});
    return Process(words, environment_);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream stream(dir_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// Missions that are over: those of the reference, two levels of noise, two of slip.
  [[nodiscard]] long missions() const {
    if (!fs::exists(dir_ / "study")) return 0;
    const fs::recursive_directory_iterator all(dir_ / "study");
    return std::count_if(begin(all), end(all),
                         [](const auto& entry) { return entry.path().filename() == "outcome.json"; });
  }
};

TEST_F(PerceptionStudy, DoesEachLevelOfEachErrorAndDrawsTheCurves) {
  Process first = study({"--seeds", "1", "--only", "noise"});
  ASSERT_EQ(first.wait(120s), 0) << first.output() << first.errors();
  EXPECT_EQ(missions(), 3);
  Process second = study({"--seeds", "2"});
  ASSERT_EQ(second.wait(120s), 0) << second.output() << second.errors();
  EXPECT_NE(second.output().find("10 of 10 missions done"), std::string::npos) << second.output();
  EXPECT_EQ(missions(), 10);
  const std::string csv = text("study/study.csv");
  for (const char* row : {"\nnoise,0.01,1,2,", "\nnoise,0.2,0,2,", "\nslip,2,0,2,", "\nslip,10,1,2,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row << " is missing in\n" << csv;
  EXPECT_EQ(text("study/study.png").substr(1, 3), "PNG");
  EXPECT_NE(text("study/study.svg").find("Slip"), std::string::npos);
  const std::string variant =
      text("study/slip/variants/robot_skin.friction_across=0.2__noise.camera_sd=0.05/60_ticks.yaml");
  EXPECT_NE(variant.find("0.05"), std::string::npos);
  expect_nobody_left();
}

TEST_F(PerceptionStudy, AnInterruptedStudyIsContinued) {
  write("400_ticks.yaml", "");
  Process begun = study({"--seeds", "3"}, "400_ticks.yaml");
  ASSERT_TRUE(eventually([&] { return missions() >= 1; })) << begun.errors();
  begun.signal(SIGINT);
  ASSERT_EQ(begun.wait(60s), 130) << begun.output() << begun.errors();
  EXPECT_NE(begun.errors().find("interrupted; the same command goes on"), std::string::npos) << begun.errors();
  EXPECT_LT(missions(), 15);
  expect_nobody_left();
  Process other = study({"--seeds", "3"});
  EXPECT_EQ(other.wait(30s), 64);
  EXPECT_NE(other.errors().find("holds a study of"), std::string::npos) << other.errors();
  Process rest = study({"--seeds", "1"}, "400_ticks.yaml");
  ASSERT_EQ(rest.wait(120s), 0) << rest.output() << rest.errors();
  EXPECT_GE(missions(), 5);
}

TEST_F(PerceptionStudy, NamesWhatIsWrong) {
  const auto refused = [&](std::vector<std::string> options, int status, const std::string& reason) {
    Process process = study(std::move(options));
    EXPECT_EQ(process.wait(30s), status) << reason << process.output();
    EXPECT_NE(process.errors().find(reason), std::string::npos) << process.errors();
  };
  refused({"--blur"}, 64, "there is no option \"--blur\"; accepted: --quick, --seeds");
  refused({"--seeds"}, 64, "--seeds: found --, accepted a whole number from 1");
  refused({"--seeds", "0"}, 64, "--seeds: found 0, accepted a whole number from 1");
  refused({"--only", "noise,fog"}, 64, "--only: found 'fog', accepted noise, slip");
  refused({"--only", "nois."}, 64, "--only: found 'nois.', accepted noise, slip");
  refused({"--only", ""}, 64, "--only needs a value");
  // Before the programs are built.
  refused({"--only", "fog", "--programs", dir_.string()}, 64, "--only: found 'fog', accepted noise, slip");
  refused({"--programs", dir_.string()}, 69, "constrictor is missing");
  refused({"--factors", "/nowhere"}, 64, "--factors: cannot read /nowhere");
  refused({"--output", "/proc/study"}, 74, "--output: cannot make the folder /proc/study");
  const std::string factors = "factors: [{name: noise, title: Noise, axis: sd, levels: [1], vary: [noise.camera_sd=@]";
  write("factors.yaml", factors + "}]\n");
  refused({}, 64, "factors.yaml:1: factors[0].reference");
  write("factors.yaml", factors + ", reference: 0}]\n");
  write("60_ticks.yaml", "noise: [");
  refused({"--seeds", "1"}, 78, "its log is");
}

TEST_F(PerceptionStudy, ARefusedStudyLeavesItsFolderForTheCorrectedCommand) {
  Process wrong = study({"--seeds", "1"}, "nosuch.yaml");
  EXPECT_EQ(wrong.wait(30s), 78) << wrong.output();
  EXPECT_NE(wrong.errors().find("nosuch.yaml"), std::string::npos) << "evaluate's reason: " << wrong.errors();
  EXPECT_NE(wrong.errors().find("the study has not begun"), std::string::npos) << wrong.errors();
  EXPECT_FALSE(fs::exists(dir_ / "study"));
  fs::create_directory(dir_ / "study");
  write("study/mine", "");
  Process again = study({"--seeds", "1"}, "nosuch.yaml");
  EXPECT_EQ(again.wait(30s), 78) << again.output();
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_ / "study"), fs::directory_iterator()), 1) << "what was there";
  Process right = study({"--seeds", "1", "--only", "noise"});
  ASSERT_EQ(right.wait(120s), 0) << right.output() << right.errors();
  // A study that has begun stays, whatever is asked of it later.
  write("60_ticks.yaml", "noise: [");
  Process later = study({"--seeds", "1", "--only", "noise"});
  EXPECT_NE(later.wait(30s), 0);
  EXPECT_NE(later.errors().find("its log is"), std::string::npos) << later.errors();
  EXPECT_TRUE(fs::exists(dir_ / "study/study.conf"));
  EXPECT_EQ(missions(), 3);
}

// It is refused before it installs and builds anything.
TEST_F(PerceptionStudy, AMisspeltScenarioIsNamedAtOnce) {
  Process process({testing::source_path("scripts/perception_study.sh"), "--scenario", "shrot", "--output",
                   (dir_ / "study").string()},
                  environment_);
  EXPECT_EQ(process.wait(10s), 64) << process.output();
  EXPECT_NE(process.errors().find("--scenario: found 'shrot', accepted a file or one of boxes, case_study, "),
            std::string::npos)
      << process.errors();
  EXPECT_FALSE(fs::exists(dir_ / "study"));
}

}  // namespace
}  // namespace constrictor::testing
