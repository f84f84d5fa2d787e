// Two runs on one host never claim the same DDS domain, even if their run directories differ.
#include "cyclone/domain_claim.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <optional>
#include <set>

#include "support/temporary_folder.hpp"
namespace constrictor {
namespace {

class DomainClaims : public ::testing::Test {
 protected:
  DomainClaims() { keep_notes_in("a"); }
  ~DomainClaims() override { ::unsetenv("XDG_RUNTIME_DIR"); }
  void keep_notes_in(const char* name) const { ::setenv("XDG_RUNTIME_DIR", (dir_ / name).c_str(), 1); }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
};

TEST_F(DomainClaims, DifferEvenIfTheRunDirectoriesDiffer) {
  const DomainClaim first;
  const DomainClaim second;
  EXPECT_NE(first.domain(), second.domain());
  keep_notes_in("b");
  const DomainClaim third;
  EXPECT_NE(third.domain(), first.domain());
  EXPECT_NE(third.domain(), second.domain());
  EXPECT_FALSE(domain_claimed(first.domain()));  // the first claim belongs to the other run directory
  EXPECT_TRUE(domain_claimed(third.domain()));
  EXPECT_THROW(DomainClaim(first.domain()), std::runtime_error);
}

TEST_F(DomainClaims, AvoidTheDomainsThatAreInUseOnOtherHosts) {
  std::set<std::uint32_t> avoid;
  for (std::uint32_t domain = 1; domain <= 80; ++domain) avoid.insert(domain);
  EXPECT_GT(DomainClaim(std::nullopt, avoid).domain(), 80u);
}

TEST_F(DomainClaims, EndWithTheirHolder) {
  // Runs choose only domains up to 100, so no run takes this one. It depends on the pid, so that two runs of this test
  // on one host do not collide.
  const std::uint32_t domain = 101 + static_cast<std::uint32_t>(::getpid()) % 129;
  std::optional<DomainClaim> claim(domain);
  EXPECT_THROW(DomainClaim{domain}, std::runtime_error);
  claim.reset();
  EXPECT_FALSE(domain_claimed(domain));
  EXPECT_NO_THROW(claim.emplace(domain));
}

}  // namespace
}  // namespace constrictor
