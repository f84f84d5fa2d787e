// A run whose robot is emulated hardware: servos behind pseudo-terminals, a camera behind an HTTP stream.
#pragma once

#include <functional>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"

namespace constrictor::testing {

class EmulatedHardware : public CliFixture {
 protected:
  using json = nlohmann::json;

  [[nodiscard]] Process run(const std::string& scenario, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "run",      scenario,         "--manifest", "emulated_hardware", "--config", "servo_bus=" + config_.string(),
        "--report", run_dir_.string()};
    // The watchdogs have more patience than usual, because a test machine may be busy.
    write("patient.yaml", "servo: {watchdog_s: 2}\n");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(std::move(arguments));
  }
  /// What the driver of the camera says of it.
  [[nodiscard]] json camera() const {
    json found = json::parse(std::ifstream(run_dir_ / "camera.json"), nullptr, false);
    return found.is_object() ? found : json::object();
  }
  [[nodiscard]] bool camera_says(const std::function<bool(const json&)>& condition) const {
    return eventually([&] {
      const json now = camera();
      return now.contains("published") && condition(now);
    });
  }
  [[nodiscard]] bool camera_is(const char* key, bool value) const {
    return camera_says([&](const json& now) { return now[key] == value; });
  }
  void order(const std::string& command) const {
    std::ofstream(run_dir_ / "camera_emulator.commands") << command << std::endl;
  }
  [[nodiscard]] std::map<std::string, pid_t> processes() const { return processes_naming(run_dir_); }
  void expect_nothing_left() const {
    EXPECT_TRUE(eventually([&] { return processes().empty(); })) << processes().begin()->first << " is left";
    for (const char* name : {"camera_emulator.url", "camera_emulator.commands", "world.state", "bus0"})
      EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(run_dir_ / name))) << name;
  }

  const std::filesystem::path run_dir_ = dir_ / "run";
  const std::filesystem::path config_ = dir_ / "patient.yaml";
};

}  // namespace constrictor::testing
