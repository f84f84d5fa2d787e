// The same on Fast DDS.
#include "outside_plant.hpp"

namespace constrictor::testing {
namespace {

#ifdef CONSTRICTOR_HAS_FAST_DDS
TEST_F(OutsidePlant, OnFastDdsIsDrivenThroughStopsAndRestarts) { is_driven("fastdds_plant"); }

TEST_F(OutsidePlant, OnFastDdsKeepsTheContract) { keeps_the_contract("fastdds_plant"); }
#endif

}  // namespace
}  // namespace constrictor::testing
