// The plants of this project keep the contract: the simulation, and the driver of servos on emulated ones.
#include <csignal>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class Conform : public CliFixture {
 protected:
  Conform() {
    write("quick.yaml", "joints: [0, 3, 7, 10, 14, 22]\nmotion: {settle_s: 0.2}\n");
    write("patient.yaml", "servo: {watchdog_s: 2}\n");
  }
  [[nodiscard]] std::vector<std::string> plant(const std::string& manifest) const {
    return {"conform",
            "plant",
            "--yes",
            "--manifest",
            manifest,
            "--profile",
            (dir_ / "quick.yaml").string(),
            "--json",
            (dir_ / "result.json").string()};
  }
  void conforms(const std::string& manifest) {
    EXPECT_EQ(command(plant(manifest), 120s), exit_status::kOk) << output_;
    const auto result = nlohmann::json::parse(std::ifstream(dir_ / "result.json"), nullptr, false);
    ASSERT_TRUE(result.is_object()) << output_;
    EXPECT_TRUE(result["conforms"].get<bool>());
    int passed = 0;
    for (const auto& check : result["checks"]) {
      passed += check["result"] == "pass";
      if (check["name"] == "restart") {
        EXPECT_EQ(check["result"], "pass") << output_;
      }
      if (check["name"] == "torque_sign") {
        EXPECT_EQ(check["result"], "pass") << "bent pitch joints lift the body\n" << output_;
      }
    }
    EXPECT_GE(passed, 25) << output_;
  }
};

TEST_F(Conform, TheSimulatedPlantConforms) {
  write("physics.yaml",
        "plant: physics\nreal_time: true\nrobot: components/lib/robot/mamba.yaml\n"
        "scenario: sim/scenarios/line.yaml\nprocesses:\n  - {components: [physics]}\n");
  conforms((dir_ / "physics.yaml").string());
}

TEST_F(Conform, TheDriverOfServosConforms) {
  write("servos.yaml",
        "plant: servo_bus\nreal_time: true\nrobot: components/lib/robot/mamba.yaml\n"
        "scenario: sim/scenarios/line.yaml\nbeside: [{program: servo_emulator}]\nprocesses:\n"
        "  - {components: [servo_bus], config: {servo_bus: " +
            (dir_ / "patient.yaml").string() + "}}\n");
  conforms((dir_ / "servos.yaml").string());
}

TEST_F(Conform, AnInterruptEndsTheRunAndNamesWhatWasNotChecked) {
  write("physics.yaml",
        "plant: physics\nreal_time: true\nrobot: components/lib/robot/mamba.yaml\n"
        "scenario: sim/scenarios/line.yaml\nprocesses:\n  - {components: [physics]}\n");
  Process process = start(plant((dir_ / "physics.yaml").string()));
  ASSERT_TRUE(process.wait_for("imu", 60s)) << process.output() << process.errors();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60s), 128 + SIGINT) << process.output() << process.errors();
  EXPECT_NE(process.output().find("not checked: "), std::string::npos) << process.output() << process.errors();
}

}  // namespace
}  // namespace constrictor::testing
