// Whole missions of external planners: they take over, also in mid-mission, and complete it by ground truth.
#include <functional>

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
  /// Runs a scenario to its end beside a planner, the program and its arguments, and expects every object in its zone
  /// by ground truth. `expect` checks what the witness has seen.
  void completes(const std::string& scenario, std::vector<std::string> arguments,
                 const std::function<void(const Witness&)>& expect) {
    Process launcher = patient_run(scenario);
    const unsigned domain = domain_of(launcher);
    ASSERT_GT(domain, 0u) << launcher.output();
    Witness witness(domain);
    arguments.insert(arguments.begin() + 1, {"--domain", std::to_string(domain)});
    Process planner(std::move(arguments));
    EXPECT_TRUE(witness.until([&] { return !planner.running(); }, 1200s));
    EXPECT_EQ(planner.wait(1s), 0) << planner.output() << planner.errors();
    EXPECT_EQ(launcher.wait(120s), 0) << planner.output() << launcher.output();
    const auto json = report();
    EXPECT_EQ(json["success"], true) << planner.output();
    for (const auto& object : json["objects"]) EXPECT_EQ(object["in_zone"], true) << object.dump();
    expect(witness);
  }
};

TEST_F(Mission, OnTheInstalledPackageRedIsRetrievedBeforeGreen) {
  completes("red_near", {example("red_first"), "--at", "5"}, [](const Witness& witness) {
    EXPECT_EQ(dropped(witness, msg::kAuthorityExternal), (std::vector<int>{msg::kColourRed, msg::kColourGreen}));
  });
}

/// The built-in planner has delivered the green object when `planner` takes over; it delivers the red one.
void expect_one_each(const Witness& witness) {
  EXPECT_EQ(dropped(witness, msg::kAuthorityPlanner), (std::vector<int>{msg::kColourGreen}));
  EXPECT_EQ(dropped(witness, msg::kAuthorityExternal), (std::vector<int>{msg::kColourRed}));
}

TEST_F(Mission, OnTheInstalledPackageTheSecondObjectIsRetrievedAfterTheBuiltInPlannerRetrievedTheFirst) {
  completes("case_study", {example("red_first"), "--order", "green,red", "--after", "1"}, expect_one_each);
}

#ifdef CONSTRICTOR_HAS_FAST_DDS
TEST_F(Mission, OnFastDdsTheSecondObjectIsRetrievedAfterTheBuiltInPlannerRetrievedTheFirst) {
  completes("case_study", {example("fastdds_planner"), "--after", "1"}, expect_one_each);
}
#endif

}  // namespace
}  // namespace constrictor::testing
