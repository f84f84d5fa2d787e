// The example plant on Cyclone DDS: it is driven through plant_relay, stopped and continued, killed and started again;
// and it keeps the contract.
#include "outside_plant.hpp"

namespace constrictor::testing {
namespace {

TEST_F(OutsidePlant, OnCycloneDdsIsDrivenThroughStopsAndRestarts) { is_driven("outside_plant"); }

TEST_F(OutsidePlant, OnCycloneDdsKeepsTheContract) { keeps_the_contract("outside_plant"); }

TEST_F(OutsidePlant, WithTheWrongNumberOfJointsDoesNotConform) {
  const nlohmann::json result = conforms("outside_plant", {"--joints", "22"});
  EXPECT_EQ(status_, 1) << output_;
  EXPECT_NE(output_.find("fail         joint_count      22 joints"), std::string::npos) << output_;
}

}  // namespace
}  // namespace constrictor::testing
