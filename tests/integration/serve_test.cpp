// `constrictor serve`: two of them, as on two hosts that were switched on, carry out one run after the other.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cyclone/domain_claim.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Serve : public ::testing::Test {
 protected:
  Serve() {
    std::ofstream(dir_.path() / "report.yaml") << "max_sim_time_s: 6\nsettle_s: 1.0\ntorque_decimation_ticks: 5\n"
                                                  "torque_window_s: 30\n";
  }
  [[nodiscard]] std::vector<std::string> files() const {
    return {"--manifest", "case_study_fast", "--scenario",
            "short",      "--config",        "report=" + (dir_.path() / "report.yaml").string()};
  }
  [[nodiscard]] Process serve(const std::string& component, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {program("constrictor"),
                                          "serve",
                                          component,
                                          "--domain",
                                          std::to_string(claim_.domain()),
                                          "--state",
                                          (dir_.path() / component).string(),
                                          "--output",
                                          (dir_.path() / "out").string()};
    const auto same = files();
    arguments.insert(arguments.end(), same.begin(), same.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments));
  }
  /// The state hashes of the runs that have ended, in the order of their folders.
  [[nodiscard]] std::vector<std::string> hashes() const {
    std::vector<fs::path> folders;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(dir_.path() / "out", none)) folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    std::vector<std::string> hashes;
    for (const auto& folder : folders) {
      const auto json = nlohmann::json::parse(std::ifstream(folder / "mission.json"), nullptr, false);
      if (json.is_object() && json.contains("state_hash")) hashes.push_back(json["state_hash"]);
    }
    return hashes;
  }
  [[nodiscard]] fs::path plant_folder(const std::string& number) const {
    return dir_.path() / "out" / ("physics+guidance+navigation+control+input+planner+report" + number);
  }
  /// Whether the run with this number has made ticks.
  [[nodiscard]] bool ticks_begun(const std::string& number) const {
    std::error_code none;
    return fs::file_size(plant_folder(number) / "hashes.bin", none) > 10'000 && !none;
  }
  [[nodiscard]] pid_t host_of(const std::string& component) const {
    for (const auto& [pid, line] : command_lines()) {
      const bool host = fs::path(line.substr(0, line.find('\0'))).filename() == "constrictor_host";
      if (host && line.find(component) < line.find("--roster") && line.find(dir_.path().string()) != std::string::npos)
        return pid;
    }
    return -1;
  }

  TemporaryFolder dir_;
  DomainClaim claim_;
};

TEST_F(Serve, TwoHostsCarryOutOneRunAfterTheOtherAlsoWhenAProcessIsKilled) {
  std::vector<std::string> arguments = {program("constrictor"), "run",      "short",
                                        "--in-process",         "--report", (dir_.path() / "reference").string()};
  auto same = files();
  same.erase(same.begin() + 2, same.begin() + 4);  // `run` takes the scenario without an option
  arguments.insert(arguments.end(), same.begin(), same.end());
  Process reference(std::move(arguments));
  ASSERT_EQ(reference.wait(60s), exit_status::kFailed) << reference.output() << reference.errors();
  const std::string expected =
      nlohmann::json::parse(std::ifstream(dir_.path() / "reference/report.json"))["state_hash"];

  Process plant = serve("physics", {"--pace", "4x"});
  Process far = serve("perception");
  EXPECT_TRUE(eventually([&] { return host_of("perception") > 0; }));
  EXPECT_TRUE(eventually([&] { return host_of("physics") > 0; }));
  ::kill(host_of("perception"), SIGKILL);
  EXPECT_TRUE(far.wait_for("was killed by signal 9 (Killed); starting it again", 20s)) << far.output();
  // The plant, too, comes back into its run.
  ASSERT_TRUE(eventually([&] { return ticks_begun(""); }, 20s)) << plant.output();
  ::kill(host_of("physics"), SIGKILL);
  EXPECT_TRUE(plant.wait_for("continues the run at tick", 20s)) << plant.output();
  EXPECT_TRUE(eventually([&] { return hashes().size() >= 2; }, 60s)) << plant.output() << far.output();
  for (const auto& hash : hashes()) EXPECT_EQ(hash, expected);
  EXPECT_NE(plant.output().find("the run is over; waiting for the next one"), std::string::npos);

  for (Process* server : {&plant, &far}) {
    server->signal(SIGTERM);
    EXPECT_EQ(server->wait(20s), exit_status::kOk) << server->output() << server->errors();
  }
  EXPECT_EQ(host_of("physics"), -1);
  EXPECT_EQ(host_of("perception"), -1);
}

TEST_F(Serve, ANewRunOfThePlantsHostDoesNotWaitForThePatienceOfTheOthers) {
  Process far = serve("perception");
  auto plant = std::make_unique<Process>(serve("physics", {"--pace", "4x"}));
  // The plant's number is higher than in the run that begins afterwards.
  ASSERT_TRUE(eventually([&] { return ticks_begun(""); }, 20s)) << plant->output();
  ::kill(host_of("physics"), SIGKILL);
  ASSERT_TRUE(plant->wait_for("continues the run at tick", 20s)) << plant->output();
  plant->signal(SIGTERM);
  ASSERT_EQ(plant->wait(20s), exit_status::kOk);
  *plant = serve("physics", {"--pace", "4x"});
  EXPECT_TRUE(far.wait_for("physics has begun another run", 30s)) << far.output();
  EXPECT_TRUE(eventually([&] { return ticks_begun("-2"); }, 20s)) << plant->output() << far.output();
  for (Process* server : {plant.get(), &far}) {
    server->signal(SIGTERM);
    EXPECT_EQ(server->wait(20s), exit_status::kOk) << server->output() << server->errors();
  }
}

TEST_F(Serve, WhatIsWrongIsSaidBeforeAnythingStarts) {
  const auto ends = [&](const std::string& component, const std::vector<std::string>& more, int status,
                        const std::string& message) {
    Process server = serve(component, more);
    EXPECT_EQ(server.wait(30s), status);
    EXPECT_NE(server.errors().find(message), std::string::npos) << server.errors();
  };
  ends("fysics", {}, exit_status::kConfiguration, "found component 'fysics', accepted physics, camera,");
  ends("physics", {"--pace", "fast"}, exit_status::kUsage, "--pace: found 'fast', accepted lockstep, realtime");
  ends("physics", {"--robot", "nobody"}, exit_status::kConfiguration, "robot: found 'nobody', accepted");
  Process without({program("constrictor"), "serve", "physics"}, {{"CONSTRICTOR_DOMAIN", ""}});
  EXPECT_EQ(without.wait(30s), exit_status::kUsage) << without.output() << without.errors();
}

}  // namespace
}  // namespace constrictor::testing
