// The texts about authority that the commands of an operator print.
#include "common/operator.hpp"

#include <gtest/gtest.h>

#include "cyclone/endpoint.hpp"

namespace constrictor::cli {
namespace {

std::optional<msg::Authority> authority(std::uint8_t level, const char* source, bool stop = false) {
  msg::Authority message{};
  message.level = level;
  message.emergency_stop = stop;
  dds::set_text(message.source, source);
  return message;
}

TEST(AuthorityText, NamesThePlannerOnceAndTheSourceOfEveryOtherLevel) {
  EXPECT_EQ(authority_text(std::nullopt), "authority: not known");
  EXPECT_EQ(authority_text(authority(msg::kAuthorityPlanner, "planner")), "authority: planner");
  EXPECT_EQ(authority_text(authority(msg::kAuthorityOperator, "task")), "authority: operator task");
  EXPECT_EQ(authority_text(authority(msg::kAuthorityNone, "")), "authority: none");
}

TEST(AuthorityText, DistinguishesAnEmergencyStopFromAnotherSource) {
  EXPECT_EQ(no_authority_text(authority(msg::kAuthorityOperator, "other"), "me"),
            "another source has authority (authority: operator other)");
  EXPECT_EQ(no_authority_text(authority(msg::kAuthorityNone, ""), "me"), "no source has authority (authority: none)");
  const auto own = no_authority_text(authority(msg::kAuthorityEmergencyStop, "me", true), "me");
  const auto other = no_authority_text(authority(msg::kAuthorityEmergencyStop, "other", true), "me");
  EXPECT_EQ(own.find("the emergency stop of this program is latched"), 0u) << own;
  EXPECT_EQ(other.find("the emergency stop of other is latched"), 0u) << other;
  for (const auto& text : {own, other}) {
    EXPECT_EQ(text.find("another source"), std::string::npos) << text;
    EXPECT_NE(text.find("`constrictor clear-stop`"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace constrictor::cli
