// The examples beside a real run from the installed prefix: they take authority, start tasks and release authority.
// Whole missions are in mission_long_test.cpp.
#include <signal.h>

#include "example_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class Takeover : public ExampleRun {
 protected:
  /// `found`: what the example prints when its goal has found the line.
  void takes_over(const std::string& name, const std::string& found) {
    Process launcher = run("short", {"--pace", "2x"});
    const unsigned domain = domain_of(launcher);
    ASSERT_GT(domain, 0u) << launcher.output() << launcher.errors();
    Witness witness(domain);
    Process planner({example(name), "--domain", std::to_string(domain), "--order", "green", "--at", "2"});
    ASSERT_TRUE(witness.until([&] { return witness.holds(name); }, 30s))
        << planner.output() << planner.errors() << launcher.output();
    // The example's own follow_line goal runs and finds the line; the built-in planner's goal has ended.
    EXPECT_TRUE(witness.until([&] { return witness.happened(msg::kTaskFollowLine, msg::kEventLineFound); }, 30s))
        << planner.output();
    EXPECT_TRUE(planner.wait_for(found, 10s)) << planner.output();
    EXPECT_EQ(witness.authority.refused_count, 0u) << witness.authority.refusal;
    // After the death of the example no source has authority.
    planner.signal(SIGKILL);
    EXPECT_TRUE(witness.until([&] { return !witness.holds(name); }, 15s));
    launcher.signal(SIGTERM);
    EXPECT_TRUE(launcher.wait(15s));
  }
};

TEST_F(Takeover, APlannerOnTheInstalledPackageTakesOverAndItsDeathReleasesAuthority) {
  takes_over("red_first", "event \"line found\" of task \"follow line\", colour blue");
}

#ifdef CONSTRICTOR_HAS_FAST_DDS
TEST_F(Takeover, APlannerOnFastDdsTakesOverAndItsDeathReleasesAuthority) {
  takes_over("fastdds_planner", "event 1 of task 1");
}
#endif

TEST_F(ExampleRun, FollowsAPathOfWaypointsAndReportsTheError) {
  // The built-in planner reaches the end of this line after 13 s. The example must have begun long before.
  Process launcher = run("line", {"--pace", "1x"});
  const unsigned domain = domain_of(launcher);
  ASSERT_GT(domain, 0u) << launcher.output() << launcher.errors();
  Process planner({example("waypoints"), "--domain", std::to_string(domain)});
  ASSERT_EQ(planner.wait(90s), 0) << planner.output() << planner.errors();
  const std::string output = planner.output();
  const auto at = output.find("cross-track error: ");
  ASSERT_NE(at, std::string::npos) << output;
  const double rms_m = std::stod(output.substr(at + 19));
  EXPECT_GT(rms_m, 0.0);
  EXPECT_LT(rms_m, 0.12);
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(15s));
}

}  // namespace
}  // namespace constrictor::testing
