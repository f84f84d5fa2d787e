// Whole missions of external planners: they take over, also in mid-mission, and complete it by ground truth.
#include "example_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

/// Colours of the objects that were dropped by goals of this authority, in order.
std::vector<int> dropped(const Witness& witness, std::uint64_t level) {
  std::vector<int> colours;
  for (const auto& event : witness.events) {
    if (event.event == msg::kEventDroppingDone && event.goal_id >> 48 == level) colours.push_back(event.colour);
  }
  return colours;
}

class Mission : public ExampleRun {
 protected:
  /// A run with more simulated time than the default: an external planner's timing is that of the wall clock.
  [[nodiscard]] Process patient_run(const std::string& scenario) const {
    return run(scenario, {"--config", "report=" + altered("sim/report/report.yaml", "max_sim_time_s: 900",
                                                          "max_sim_time_s: 1900")});
  }
  /// Runs to the end beside `planner` and expects every object in its zone by ground truth.
  void completes(Process& launcher, Process& planner, Witness& witness) {
    EXPECT_TRUE(witness.until([&] { return !planner.running(); }, 1200s));
    EXPECT_EQ(planner.wait(1s), 0) << planner.output() << planner.errors();
    EXPECT_EQ(launcher.wait(120s), 0) << planner.output() << launcher.output();
    const auto json = report();
    EXPECT_EQ(json["success"], true) << planner.output();
    for (const auto& object : json["objects"]) EXPECT_EQ(object["in_zone"], true) << object.dump();
  }
};

TEST_F(Mission, OnTheInstalledPackageRedIsRetrievedBeforeGreen) {
  Process launcher = patient_run("red_near");
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  Witness witness(domain);
  Process planner({example("red_first"), "--domain", std::to_string(domain), "--at", "5"});
  completes(launcher, planner, witness);
  EXPECT_EQ(dropped(witness, msg::kAuthorityExternal), (std::vector<int>{msg::kColourRed, msg::kColourGreen}));
}

/// The built-in planner has delivered the green object when `planner` takes over; it delivers the red one.
void expect_one_each(const Witness& witness) {
  EXPECT_EQ(dropped(witness, msg::kAuthorityPlanner), (std::vector<int>{msg::kColourGreen}));
  EXPECT_EQ(dropped(witness, msg::kAuthorityExternal), (std::vector<int>{msg::kColourRed}));
}

TEST_F(Mission, OnTheInstalledPackageTheSecondObjectIsRetrievedAfterTheBuiltInPlannerRetrievedTheFirst) {
  Process launcher = patient_run("case_study");
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  Witness witness(domain);
  Process planner({example("red_first"), "--domain", std::to_string(domain), "--order", "green,red", "--after", "1"});
  completes(launcher, planner, witness);
  expect_one_each(witness);
}

#ifdef CONSTRICTOR_HAS_FAST_DDS
TEST_F(Mission, OnFastDdsTheSecondObjectIsRetrievedAfterTheBuiltInPlannerRetrievedTheFirst) {
  Process launcher = patient_run("case_study");
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output();
  Witness witness(domain);
  Process planner({example("fastdds_planner"), "--domain", std::to_string(domain), "--after", "1"});
  completes(launcher, planner, witness);
  expect_one_each(witness);
}
#endif

}  // namespace
}  // namespace constrictor::testing
