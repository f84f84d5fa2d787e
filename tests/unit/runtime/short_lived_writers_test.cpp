// The type of a writer is requested while the writer's process ends its use of it. Cyclone DDS 0.10.2 then reads memory
// that it has freed, and aborts, unless the process that asks refers to the type itself.
#include <foreign.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "cyclone/discovery.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor::dds {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Makes writers of two types that live for 0 to 3 ms.
[[noreturn]] void churn(std::uint32_t domain, Clock::duration bound) {
  const Domain joined(domain);
  const auto end = Clock::now() + bound;
  for (int i = 0; Clock::now() < end; ++i) {
    const Entity topic(dds_create_topic(joined.participant(), i % 2 == 0 ? &foreign_Weather_desc : &foreign_Tide_desc,
                                        ("short_lived_" + std::to_string(i)).c_str(), nullptr, nullptr),
                       "dds_create_topic");
    const Entity writer(dds_create_writer(joined.participant(), topic.get(), nullptr, nullptr), "dds_create_writer");
    dds_sleepfor(DDS_USECS(i * 997 % 3000));
  }
  ::_exit(0);
}

TEST(ShortLivedWriters, AskingForTheirTypesIsSafe) {
  const DomainClaim claim;
  const pid_t child = ::fork();  // before this process uses DDS
  ASSERT_GE(child, 0);
  if (child == 0) churn(claim.domain(), 4s);
  ::mallopt(M_PERTURB, 0xc8);  // what is read after it was freed is no valid type
  {
    const Domain joined(claim.domain());
    const Discovery discovery(joined.participant());
    int asked = 0, answered = 0;
    while (::waitpid(child, nullptr, WNOHANG) == 0) {
      for (const Endpoint& endpoint : discovery.endpoints()) {
        if (!endpoint.writer || endpoint.type_info == nullptr) continue;
        ++asked;
        if (TypeTree::find(joined.participant(), endpoint, 20ms)) ++answered;
      }
    }
    EXPECT_GT(asked, 20);
    EXPECT_GT(answered, 0);
    std::printf("%d of %d types were described\n", answered, asked);
  }
}

}  // namespace
}  // namespace constrictor::dds
