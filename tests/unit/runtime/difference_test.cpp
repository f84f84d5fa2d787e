// What all members of a run must have in common.
#include <gtest/gtest.h>

#include "barrier/protocol.hpp"

namespace constrictor {
namespace {

Hello member() {
  Hello hello;
  hello.release = "1.0";
  hello.idl_hash = "idl";
  hello.config_hash = "config";
  hello.numeric_profile = "profile";
  hello.component_hash = component_hash(std::string(64, 'a'), std::string(64, 'd'));
  return hello;
}

TEST(Difference, ReleaseAndScenarioMustBeEqualAndAllDifferencesAreNamed) {
  Hello other = member();
  EXPECT_FALSE(difference(other, member()));
  other.release = "0.9";
  EXPECT_EQ(difference(other, member()), "release differs: found 0.9, the run has 1.0");
  other.component_hash = component_hash(std::string(64, 'b'), std::string(64, 'd'));
  EXPECT_EQ(difference(other, member()),
            "release differs: found 0.9, the run has 1.0; "
            "scenario differs: found bbbbbbbbbbbb..., the run has aaaaaaaaaaaa...");
}

TEST(Difference, ComponentsHaveDifferentConfigurations) {
  Hello other = member();
  other.component_hash = component_hash(std::string(64, 'a'), std::string(64, 'e'));
  EXPECT_NE(other.component_hash, member().component_hash);
  EXPECT_FALSE(difference(other, member()));
}

TEST(Difference, AProgramOfAnotherProjectNeedsNeitherReleaseNorScenario) {
  Hello other = member();
  other.release = "";
  other.component_hash = "my planner, version 3";
  EXPECT_FALSE(difference(other, member()));
}

TEST(Difference, TheHashOfAComponentFitsIntoItsField) {
  EXPECT_LE(component_hash(std::string(64, 'a'), std::string(64, 'b')).size(), 64u);
  EXPECT_EQ(scenario_part(component_hash(std::string(64, 'a'), "")), std::string(28, 'a'));
  EXPECT_EQ(scenario_part("anything"), "");
}

}  // namespace
}  // namespace constrictor
