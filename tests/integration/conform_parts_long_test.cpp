// `constrictor conform PART` on real processes over DDS: the project's own parts keep the contract, and faults that are
// planted in them are named. All faults are found without DDS in tests/unit/conform.
#include <fmt/format.h>

#include <csignal>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class ConformParts : public CliFixture {
 protected:
  [[nodiscard]] std::vector<std::string> conform(const std::string& part, const std::string& manifest) const {
    return {"conform", part, "--yes", "--manifest", manifest, "--json", (dir_ / "result.json").string()};
  }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(std::ifstream(dir_ / "result.json"), nullptr, false);
  }
  void conforms(const std::string& part, const std::string& manifest, int checks) {
    EXPECT_EQ(command(conform(part, manifest), 150s), exit_status::kOk) << output_;
    const auto found = result();
    ASSERT_TRUE(found.is_object()) << output_;
    EXPECT_TRUE(found["conforms"].get<bool>());
    int passed = 0;
    for (const auto& check : found["checks"]) passed += check["result"] == "pass";
    EXPECT_GE(passed, checks) << output_;
  }
  /// The first check that fails is this one.
  void is_named(const std::string& part, const std::string& fault, const std::string& expected) {
    write("faulty.yaml",
          "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\n"
          "processes:\n  - {components: [physics]}\n  - {components: [" +
              part + "], program: faulty_part, environment: [CONSTRICTOR_FAULT=" + fault + "]}\n");
    EXPECT_EQ(command(conform(part, (dir_ / "faulty.yaml").string()), 150s), exit_status::kFailed) << output_;
    std::string first;
    const auto found = result();
    ASSERT_TRUE(found.is_object()) << output_;
    for (const auto& check : found["checks"]) {
      if (check["result"] == "fail" && first.empty()) first = check["name"];
    }
    EXPECT_EQ(first, expected) << output_;
  }
};

TEST_F(ConformParts, OurControlConforms) { conforms("control", "case_study", 37); }

TEST_F(ConformParts, FaultsOfAControlAreNamed) {
  is_named("control", "sign", "sign");
  is_named("control", "counts_nothing", "wrong_joints");
  is_named("control", "jumps_after_restart", "restart");
}

TEST_F(ConformParts, OurPerceptionConforms) { conforms("perception", "case_study", 33); }

TEST_F(ConformParts, FaultsOfAPerceptionAreNamed) {
  is_named("perception", "mirrored", "line_sign");
  is_named("perception", "counts_nothing", "wrong_size");
}

TEST_F(ConformParts, OurPlannerConforms) { conforms("planner", "case_study", 28); }

TEST_F(ConformParts, FaultsOfAPlannerAreNamed) { is_named("planner", "obeys_all_goals", "wrong_goal"); }

TEST_F(ConformParts, TheSimulatedCameraConforms) { conforms("camera", "case_study", 18); }

TEST_F(ConformParts, FaultsOfACameraAreNamed) { is_named("camera", "mirrored", "mirrored"); }

TEST_F(ConformParts, TheEmulatedCameraConforms) { conforms("camera", "emulated_hardware", 17); }

TEST_F(ConformParts, ACameraThatShowsAFolderConformsWithoutMotion) {
  std::filesystem::create_directory(dir_ / "pictures");
  for (int i = 0; i < 40; ++i) {
    cv::Mat picture(240, 320, CV_8UC3);
    cv::randu(picture, 0, 255);
    cv::imwrite((dir_ / "pictures" / fmt::format("{:03}.png", i)).string(), picture);
  }
  write("camera.yaml", "source: " + (dir_ / "pictures").string() + "\nfile: {repeat: true}\n");
  write("folder.yaml",
        "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/line.yaml\n"
        "processes:\n  - {components: [physics]}\n  - {components: [camera], program: video_capture, "
        "config: {camera: " +
            (dir_ / "camera.yaml").string() + "}}\n");
  write("still.yaml", "motion: {moves: false}\n");
  auto words = conform("camera", (dir_ / "folder.yaml").string());
  words.insert(words.end(), {"--profile", (dir_ / "still.yaml").string()});
  EXPECT_EQ(command(words, 100s), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("the head is not moved"), std::string::npos) << output_;
}

TEST_F(ConformParts, AnObserverOfARunMovesNothing) {
  Process run = start({"run", "--manifest", "case_study", "--pace", "1x", "--report", (dir_ / "run").string()});
  ASSERT_TRUE(eventually([&] { return domain() != 0; }, 60s)) << run.output();
  EXPECT_EQ(command({"conform", "camera", "--domain", std::to_string(domain())}, 100s), exit_status::kOk) << output_;
  run.signal(SIGINT);
  EXPECT_TRUE(run.wait(60s).has_value());
}

TEST_F(ConformParts, RefusesWhatItCannotCheck) {
  EXPECT_EQ(command({"conform", "control"}), exit_status::kUsage);
  EXPECT_NE(output_.find("accepted one of them: the control in this domain, or that of this manifest"),
            std::string::npos)
      << output_;
  EXPECT_EQ(command(conform("control", "emulated_camera_only.yaml")), exit_status::kConfiguration) << output_;
  write("no_control.yaml",
        "plant: physics\nrobot: components/lib/robot/mamba.yaml\n"
        "scenario: sim/scenarios/line.yaml\nprocesses:\n  - {components: [physics]}\n");
  EXPECT_EQ(command(conform("control", (dir_ / "no_control.yaml").string())), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("found no control"), std::string::npos) << output_;
}

}  // namespace
}  // namespace constrictor::testing
