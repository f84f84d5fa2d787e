// Two runs on one host never claim the same DDS domain, even if their run directories differ.
#include "cyclone/domain_claim.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <thread>

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

TEST_F(DomainClaims, RemoveWhatAKilledOwnerHasLeft) {
  const std::uint32_t domain = 101 + static_cast<std::uint32_t>(::getpid()) % 129;
  const std::string number = std::to_string(domain);
  const auto files = {"run-" + number + ".json", "run-" + number + ".token", "replay-" + number + ".sock"};
  for (const auto& file : files) std::ofstream(run_directory() / file) << "left";
  std::ofstream(run_directory() / "run-1000.json") << "of another domain";
  const DomainClaim claim(domain);
  for (const auto& file : files) EXPECT_FALSE(std::filesystem::exists(run_directory() / file)) << file;
  EXPECT_TRUE(std::filesystem::exists(run_directory() / "run-1000.json"));
}

TEST_F(DomainClaims, AreNotSeenWhereOnlyObserversLook) {
  const std::uint32_t domain = 101 + static_cast<std::uint32_t>(::getpid()) % 129;
  { const DomainClaim claim(domain); }  // leaves the file of the lock
  std::atomic<bool> stop{false};
  std::atomic<int> seen{0}, looks{0};
  const auto look = [&] {
    for (; !stop; ++looks)
      if (domain_claimed(domain)) ++seen;
  };
  std::thread one(look), other(look);
  while (looks < 2000) std::this_thread::yield();
  EXPECT_EQ(seen, 0) << "one observer took the other for a claim";
  EXPECT_NO_THROW(DomainClaim{domain}) << "an observer that looks for a moment prevents no claim";
  stop = true;
  one.join();
  other.join();
}

}  // namespace
}  // namespace constrictor
