// ClientLink detects which clients are alive with the help of DDS, even for clients of which its reader has never
// received a request.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "client/request_writer.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "runtime/client_link.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;

using testing::eventually;

class ClientLinkTest : public ::testing::Test {
 protected:
  /// A client: a participant with a writer of requests.
  struct Program {
    Program(std::uint32_t domain, std::int64_t lease_ns)
        : participant(dds_create_participant(domain, nullptr, nullptr), "dds_create_participant"),
          writer(participant.get(), lease_ns) {}
    void send(const std::string& source, std::uint64_t number, std::uint8_t level = msg::kAuthorityExternal) const {
      msg::Request request{};
      request.robot_id = 1;
      dds::set_text(request.source, source);
      request.header.sequence_number = number;
      request.level = level;
      request.kind = kind;
      writer.write(request);
    }
    dds::Entity participant;
    RequestWriter writer;
    std::uint8_t kind = msg::kRequestTake;
  };
  [[nodiscard]] std::unique_ptr<Program> program(std::int64_t lease_ns = 0) const {
    auto made = std::make_unique<Program>(claim_.domain(), lease_ns);
    EXPECT_TRUE(eventually([&] { return made->writer.heard(); }));
    return made;
  }
  /// Waits until the latch has returned at least `count` items, and returns them.
  std::vector<ClientEvent> latched(const ClientLink& link, std::size_t count,
                                   const std::vector<LivingSource>& living = {}) {
    std::vector<ClientEvent> items;
    EXPECT_TRUE(eventually([&] {
      link.take(requests_, [this](const std::string& reason) { refusal_ = reason; });
      for (auto& item : requests_.latch(living)) items.push_back(std::move(item));
      return items.size() >= count;
    }));
    return items;
  }

  const DomainClaim claim_;
  const dds::Domain robot_{claim_.domain()};
  ClientRequests requests_;
  std::string refusal_;
};

TEST_F(ClientLinkTest, ClientsWithTheSameNameAreDistinguishedByTheirWriters) {
  const ClientLink link(robot_.participant(), 1);
  const auto first = program();
  first->send("p", 57);
  const auto of_first = latched(link, 1);
  ASSERT_EQ(of_first.size(), 1u);
  const auto second = program();
  second->send("p", 1);
  const auto of_second = latched(link, 1);
  ASSERT_EQ(of_second.size(), 1u);
  EXPECT_NE(of_first[0].writer, WriterId{});
  EXPECT_NE(of_second[0].writer, WriterId{});
  EXPECT_NE(of_first[0].writer, of_second[0].writer);
}

TEST_F(ClientLinkTest, AReaderThatHasReceivedNothingFromASourceDetectsItsDeath) {
  auto before = std::make_unique<ClientLink>(robot_.participant(), 1);
  auto operates = program();
  const auto hangs = program(500'000'000);
  operates->send("operates", 1);
  hangs->send("hangs", 1);
  std::vector<LivingSource> living;
  for (const auto& item : latched(*before, 2)) living.push_back({item.source, item.writer});
  before.reset();
  ASSERT_EQ(living.size(), 2u);
  const ClientLink after(robot_.participant(), 1, {}, 60s);  // as in a restarted process of `input`
  after.track_writers_for(requests_);
  hangs->writer.assert_alive();
  const auto first_death = latched(after, 1, living);  // it no longer asserts that it is alive
  ASSERT_EQ(first_death.size(), 1u);
  EXPECT_TRUE(first_death[0].died);
  EXPECT_EQ(first_death[0].source, "hangs");
  std::erase_if(living, [](const LivingSource& source) { return source.source == "hangs"; });
  EXPECT_TRUE(requests_.latch(living).empty());
  operates.reset();
  const auto second_death = latched(after, 1, living);
  ASSERT_EQ(second_death.size(), 1u);
  EXPECT_TRUE(second_death[0].died);
  EXPECT_EQ(second_death[0].source, "operates");
}

TEST_F(ClientLinkTest, ASourceThatIsNotFoundWithinTheGraceIsDead) {
  const ClientLink link(robot_.participant(), 1, {}, 300ms);
  link.track_writers_for(requests_);
  const auto alive = program();
  alive->send("alive", 1);
  const WriterId writer = latched(link, 1).at(0).writer;
  const std::vector<LivingSource> living = {{"alive", writer}, {"died during the restart", WriterId{1, 2, 3}}};
  const auto deaths = latched(link, 1, living);
  ASSERT_EQ(deaths.size(), 1u);
  EXPECT_TRUE(deaths[0].died);
  EXPECT_EQ(deaths[0].writer, living[1].writer);
}

TEST_F(ClientLinkTest, ARequestOutOfRangeIsRefusedWithItsFieldExceptAnEmergencyStop) {
  const ClientLink link(robot_.participant(), 1);
  const auto wild = program();
  wild->send("wild", 1, 77);
  const auto refused = latched(link, 1);
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].refusal.find("level"), std::string::npos) << refused[0].refusal;
  EXPECT_NE(refusal_.find("request/v2.level"), std::string::npos) << refusal_;
  wild->kind = msg::kRequestEmergencyStop;
  wild->send("wild", 2, 77);
  const auto stop = latched(link, 1);
  ASSERT_EQ(stop.size(), 1u);
  EXPECT_EQ(stop[0].request.kind, msg::kRequestEmergencyStop);
  EXPECT_TRUE(stop[0].refusal.empty());
}

}  // namespace
}  // namespace constrictor
