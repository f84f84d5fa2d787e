// `ros_bridge` finds the run that it bridges as the command `constrictor` does.
#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class RosBridgeCommand : public RunCommand {
 protected:
  RosBridgeCommand() {
    environment_ = {{"XDG_RUNTIME_DIR", dir_.string()},
                    {"ROS_LOCALHOST_ONLY", "1"},
                    {"ROS_DOMAIN_ID", std::to_string(150 + ::getpid() % 70)}};
  }
  [[nodiscard]] Process bridge(std::vector<std::string> arguments = {}) const {
    arguments.insert(arguments.begin(), program("ros_bridge"));
    return Process(std::move(arguments), environment_);
  }
};

TEST_F(RosBridgeCommand, BridgesTheOnlyRunUntilItEndsAndRefusesToChooseAmongSeveral) {
  Process nothing = bridge();
  EXPECT_EQ(nothing.wait(20s), exit_status::kSoftware);
  EXPECT_NE(nothing.errors().find("no run on this host"), std::string::npos) << nothing.errors();

  Process first = run(1'000'000, "first", {"--pace", "1x"});
  const unsigned domain = domain_of(first);
  ASSERT_GT(domain, 0u) << first.output();
  Process only = bridge();
  EXPECT_TRUE(only.wait_for("/task/request", 20s)) << only.errors();
  EXPECT_EQ(only.output().rfind("run " + std::to_string(domain) + " (1000000_ticks, seed 1, robot mamba)", 0), 0u)
      << only.output();
  EXPECT_NE(only.output().find("is node /ros_bridge in ROS_DOMAIN_ID " + environment_.at("ROS_DOMAIN_ID")),
            std::string::npos);

  Process second = run(1'000'000, "second", {"--pace", "1x"});
  const unsigned other = domain_of(second);
  ASSERT_GT(other, 0u) << second.output();
  Process unsure = bridge();
  EXPECT_EQ(unsure.wait(20s), exit_status::kSoftware);
  for (const unsigned each : {domain, other})
    EXPECT_NE(unsure.errors().find("--run " + std::to_string(each)), std::string::npos) << unsure.errors();
  EXPECT_EQ(unsure.output(), "");

  first.signal(SIGTERM);
  EXPECT_TRUE(first.wait(20s));
  EXPECT_EQ(only.wait(20s), exit_status::kOk) << only.errors();
  EXPECT_NE(only.output().find("the run has ended"), std::string::npos) << only.output();
  second.signal(SIGTERM);
  EXPECT_TRUE(second.wait(20s));
}

TEST_F(RosBridgeCommand, RefusesWrongOptionsWithWhatIsAccepted) {
  for (const auto& [option, value, said] : std::initializer_list<std::tuple<std::string, std::string, std::string>>{
           {"--ros-distro", "noetic", "ros_bridge: --ros-distro: found 'noetic', accepted humble, "},
           {"--ros-domain", "300", "--ros-domain: found '300', accepted a whole number from 0 to 229"},
           {"--level", "king", "operator"},
           {"--robot", "nothing.yaml", "nothing.yaml"}}) {
    Process refused = bridge({option, value});
    EXPECT_EQ(refused.wait(20s), exit_status::kUsage) << option;
    EXPECT_NE(refused.errors().find(said), std::string::npos) << refused.errors();
  }
}

}  // namespace
}  // namespace constrictor::testing
