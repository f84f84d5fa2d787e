// `constrictor conform plant` over DDS names each fault that is planted in a driver on the topics hardware/*. The same
// faults are found without DDS in tests/unit/conform.
#include "cyclone/domain_claim.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/joint_faults.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class Drivers : public CliFixture {
 protected:
  nlohmann::json examined(const std::string& fault) {
    write("quick.yaml", "joints: [0, 2, 3, 4, 5, 6, 7, 9]\n");
    const DomainClaim claim;
    const std::string domain = std::to_string(claim.domain());
    Process driver({program("faulty_driver"), domain, "23", fault});
    status_ =
        command({"conform", "plant", "--domain", domain, "--yes", "--profile", (dir_ / "quick.yaml").string(), "--json",
                 (dir_ / "result.json").string(), "--restart-command", "kill -USR1 " + std::to_string(driver.pid())},
                240s);
    driver.signal(SIGKILL);
    return nlohmann::json::parse(std::ifstream(dir_ / "result.json"), nullptr, false);
  }
  int status_ = -1;
};

TEST_F(Drivers, ARightOneConforms) {
  const auto result = examined("");
  EXPECT_EQ(status_, exit_status::kOk) << output_;
  ASSERT_TRUE(result.is_object()) << output_;
  EXPECT_TRUE(result["conforms"].get<bool>()) << output_;
  EXPECT_NE(output_.find("pass         restart"), std::string::npos) << output_;
}

class FaultyDrivers : public Drivers, public ::testing::WithParamInterface<NamedFault> {};

TEST_P(FaultyDrivers, AreNamed) {
  const auto result = examined(GetParam().fault);
  EXPECT_EQ(status_, exit_status::kFailed) << output_;
  ASSERT_TRUE(result.is_object()) << output_;
  std::string first;
  for (const auto& check : result["checks"]) {
    if (check["result"] == "fail" && first.empty()) first = check["name"];
  }
  EXPECT_EQ(first, GetParam().check) << output_;
}

/// A process on these topics knows neither stops nor epochs: plant_relay answers for both.
std::vector<NamedFault> faults_of_drivers() {
  std::vector<NamedFault> faults;
  for (const NamedFault& fault : kJointFaults) {
    const std::string check = fault.check;
    if (check != "stop" && check != "epoch") faults.push_back(fault);
  }
  return faults;
}

INSTANTIATE_TEST_SUITE_P(OverDds, FaultyDrivers, ::testing::ValuesIn(faults_of_drivers()),
                         [](const auto& test) { return std::string(test.param.fault); });

}  // namespace
}  // namespace constrictor::testing
