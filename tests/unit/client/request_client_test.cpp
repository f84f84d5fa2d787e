// The conclusions of a client while `input` is killed and restarted: the new process publishes the last messages of its
// predecessor again, and the client must not take them for new ones.
#include "client/request_client.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include "constrictor/topics.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
using Answer = RequestClient::Answer;

constexpr std::uint64_t kRun = 7;

/// An `input` that publishes the messages of a test.
class RequestClientTest : public ::testing::Test {
 protected:
  RequestClientTest() { restart_input(); }
  /// Another process of `input`: a new writer, with the messages that the old one kept.
  void restart_input(const std::function<void()>& after_each = [] {}) {
    writer_ = dds::Writer<msg::Authority>(client_.participant(), std::string(topics::kAuthority.name), 8);
    for (const msg::Authority& message : std::exchange(kept_, {})) {
      publish(message);
      after_each();
    }
  }
  void publish(const msg::Authority& message) {
    kept_.push_back(message);
    if (kept_.size() > 8) kept_.erase(kept_.begin());
    writer_.write(message);
  }
  void publish(std::int64_t tick, bool stop, std::uint8_t level, std::uint32_t epoch = 1, std::uint64_t run_id = kRun,
               std::uint32_t incarnation = 1) {
    msg::Authority message{};
    message.header.run_id = run_id;
    message.header.epoch = epoch;
    message.header.incarnation = incarnation;
    message.header.tick = tick;
    message.header.sequence_number = static_cast<std::uint64_t>(tick) + 1;  // one a tick
    message.emergency_stop = stop;
    message.level = level;
    dds::set_text(message.source, level == msg::kAuthorityOperator ? client_.source() : "");
    publish(message);
  }
  bool receives(std::int64_t tick) {
    return testing::eventually([&] {
      client_.poll();
      return client_.authority() && client_.authority()->header.tick == tick;
    });
  }
  /// After a message that must not change anything. Within a process DDS has delivered it when the writer returns.
  void keeps_authority() {
    client_.poll();
    ASSERT_TRUE(client_.holds_authority()) << "tick " << client_.authority()->header.tick;
  }

  static RequestClientOptions options() {
    RequestClientOptions options;
    options.source = "hand";
    options.level = msg::kAuthorityOperator;
    options.lease = 0ms;
    return options;
  }

  const DomainClaim claim_;
  RequestClient client_{claim_.domain(), options()};
  dds::Writer<msg::Authority> writer_;
  std::vector<msg::Authority> kept_;
};

TEST_F(RequestClientTest, AnEarlierStopDoesNotConfirmANewOne) {
  publish(10, true, msg::kAuthorityEmergencyStop);  // an earlier stop, which was cleared
  publish(11, false, msg::kAuthorityNone);
  publish(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(receives(12));
  const std::uint64_t stop = client_.ask(msg::kRequestEmergencyStop);
  restart_input();
  EXPECT_EQ(client_.wait_for_answer(stop, 300ms), Answer::kNone) << "no process of `input` has received the request";
  publish(13, true, msg::kAuthorityEmergencyStop);
  EXPECT_EQ(client_.wait_for_answer(stop, 5s), Answer::kGranted);
}

TEST_F(RequestClientTest, TheFirstMessageDoesNotConfirmAStop) {
  const std::uint64_t stop = client_.ask(msg::kRequestEmergencyStop);
  publish(10, true, msg::kAuthorityEmergencyStop);
  ASSERT_TRUE(receives(10));
  EXPECT_EQ(client_.wait_for_answer(stop, 100ms), Answer::kNone);
  publish(11, true, msg::kAuthorityEmergencyStop);
  EXPECT_EQ(client_.wait_for_answer(stop, 5s), Answer::kGranted);
}

TEST_F(RequestClientTest, AuthorityDoesNotGoBackInTime) {
  publish(10, false, msg::kAuthorityNone);
  publish(11, false, msg::kAuthorityPlanner);
  publish(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(receives(12));
  ASSERT_TRUE(client_.holds_authority());
  restart_input([this] { keeps_authority(); });
}

TEST_F(RequestClientTest, IgnoresTheAuthorityOfAnotherRun) {
  publish(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(receives(12));
  publish(40, true, msg::kAuthorityEmergencyStop, 1, kRun + 1);
  keeps_authority();
  publish(13, false, msg::kAuthorityOperator);
  ASSERT_TRUE(receives(13));
  EXPECT_TRUE(client_.holds_authority());
}

TEST_F(RequestClientTest, FollowsANewEpochAndARepeatedTick) {
  publish(12, false, msg::kAuthorityOperator);
  ASSERT_TRUE(receives(12));
  publish(0, false, msg::kAuthorityPlanner, 2);
  ASSERT_TRUE(receives(0));
  EXPECT_FALSE(client_.holds_authority());
  publish(1, false, msg::kAuthorityPlanner, 2);
  ASSERT_TRUE(receives(1));
  publish(1, false, msg::kAuthorityOperator, 2, kRun, 2);  // the restarted `input` repeats the tick
  EXPECT_TRUE(testing::eventually([&] {
    client_.poll();
    return client_.holds_authority();
  }));
}

}  // namespace
}  // namespace constrictor
