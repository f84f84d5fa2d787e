// The same on Fast DDS.
#include "outside_plant.hpp"

namespace constrictor::testing {
namespace {

#ifdef CONSTRICTOR_HAS_FAST_DDS
TEST_F(OutsidePlant, OnFastDdsIsDrivenThroughStopsAndRestarts) { is_driven("fastdds_plant"); }

TEST_F(OutsidePlant, OnFastDdsKeepsTheContract) {
  const nlohmann::json result = conforms("fastdds_plant");
  EXPECT_EQ(status_, 0) << output_;
  ASSERT_TRUE(result.is_object()) << output_;
  EXPECT_TRUE(result["conforms"].get<bool>()) << output_;
}
#endif

}  // namespace
}  // namespace constrictor::testing
