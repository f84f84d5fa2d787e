// The latch of clients' requests: their order, its limits, deaths of sources; and requests that await their answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>

#include "client/unanswered_requests.hpp"
#include "component/client_requests.hpp"
#include "input/arbiter.hpp"
#include "requests.hpp"

namespace constrictor {
namespace {

msg::Request motion(const std::string& source, std::uint8_t level, std::uint64_t sequence,
                    std::uint8_t what = msg::kMotionDrive) {
  auto r = request(source, level, msg::kRequestMotion, sequence);
  r.motion = what;
  return r;
}

/// The latched requests without the refused ones.
std::vector<ClientEvent> kept(ClientRequests& clients) {
  auto items = clients.latch();
  std::erase_if(items, [](const ClientEvent& item) { return !item.refusal.empty(); });
  return items;
}

TEST(ClientRequests, TheOrderOfArrivalDoesNotMatter) {
  std::vector<msg::Request> requests;
  for (const std::string source : {"b", "a", "c"}) {
    for (std::uint64_t number = 1; number <= 4; ++number) {
      requests.push_back(request(source, kExternal, msg::kRequestTask, number, number));
    }
  }
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::shuffle(requests.begin(), requests.end(), random);
    ClientRequests clients;
    clients.add_death("b");
    for (const auto& r : requests) clients.add(r);
    const auto items = clients.latch();
    ASSERT_EQ(items.size(), 13u);
    std::string order;
    for (const auto& item : items)
      order += item.source + (item.died ? "x" : std::to_string(item.request.header.sequence_number));
    EXPECT_EQ(order, "a1a2a3a4b1b2b3b4c1c2c3c4bx");
    EXPECT_TRUE(clients.latch().empty());
  }
}

TEST(ClientRequests, KeepsTheNewestMotionsAndTheStandAtTheirEnd) {
  ClientRequests clients;
  for (std::uint64_t i = 1; i <= 100; ++i) clients.add(motion("pilot", kOperator, i));
  clients.add(motion("pilot", kOperator, 101, msg::kMotionStand));
  const auto items = clients.latch();
  EXPECT_EQ(items.back().request.header.sequence_number, 101u);
  EXPECT_EQ(items.back().request.motion, msg::kMotionStand);
  EXPECT_EQ(items[items.size() - 2].request.header.sequence_number, 100u);
  std::uint64_t refused = 0;
  std::uint64_t decided = 0;
  for (const auto& item : items) (item.refusal.empty() ? decided : refused) += item.times;
  EXPECT_EQ(refused + decided, 101u) << "every request is counted";
  EXPECT_EQ(refused, clients.dropped());
  EXPECT_TRUE(std::is_partitioned(items.begin(), items.end(), [](const ClientEvent& i) { return !i.refusal.empty(); }));
}

TEST(ClientRequests, KeepsATaskAmongManyMotionsOfItsSource) {
  ClientRequests clients;
  clients.add(request("x", kExternal, msg::kRequestTask, 1));
  for (std::uint64_t i = 2; i <= 40; ++i) clients.add(motion("x", kExternal, i));
  EXPECT_EQ(kept(clients).front().request.kind, msg::kRequestTask);
}

TEST(ClientRequests, ManyRequestsOfPlannersLeaveRoomForAnOperator) {
  ClientRequests clients;
  clients.add(request("pilot", kOperator, msg::kRequestTake, 1));
  for (int source = 0; source < 40; ++source) {
    for (std::uint64_t i = 1; i <= 30; ++i) clients.add(motion("chat" + std::to_string(source), kExternal, i));
    clients.add(request("chat" + std::to_string(source), kExternal, msg::kRequestRelease, 31));
  }
  clients.add(motion("pilot", kOperator, 2));
  clients.add(request("pilot", kOperator, msg::kRequestRelease, 3));
  const auto items = kept(clients);
  EXPECT_LE(items.size(), 64u);
  ASSERT_GE(items.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(items[i].source, "pilot");
    EXPECT_EQ(items[i].request.header.sequence_number, i + 1);
  }
}

TEST(ClientRequests, AnEmergencyStopFindsRoomAmongAnyNumberOfRequests) {
  ClientRequests clients;
  for (int source = 0; source < 100; ++source) {
    for (std::uint64_t i = 1; i <= 30; ++i)
      clients.add(request("s" + std::to_string(source), kOperator, msg::kRequestTask, i, i));
  }
  clients.add(request("x", 0, msg::kRequestEmergencyStop, 1));
  clients.add(request("x", 0, msg::kRequestEmergencyStop, 2));
  const auto items = kept(clients);
  EXPECT_EQ(std::count_if(items.begin(), items.end(),
                          [](const auto& i) { return i.request.kind == msg::kRequestEmergencyStop; }),
            1);
  EXPECT_EQ(items.back().request.header.sequence_number,
            2u);  // the newest stop of a source, which waits for its answer
}

TEST(ClientRequests, ARequestRepeatedUnderItsNumberCountsOnce) {
  ClientRequests clients;
  for (int i = 0; i < 50; ++i) clients.add(request("x", kExternal, msg::kRequestTake, 7), writer(1));
  EXPECT_EQ(clients.latch().size(), 1u);
  EXPECT_EQ(clients.dropped(), 0u);
}

TEST(ClientRequests, RequestsOfASuccessorComeAfterThoseOfTheFormerProcessOfTheName) {
  ClientRequests clients;
  clients.add(request("x", kExternal, msg::kRequestTake, 57), writer(1));
  clients.add(request("x", kExternal, msg::kRequestTake, 1), writer(2));
  clients.add(request("x", kExternal, msg::kRequestRelease, 2), writer(2));
  const auto items = clients.latch();
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].request.header.sequence_number, 57u);
  EXPECT_EQ(items[1].request.header.sequence_number, 1u);
  EXPECT_EQ(items[2].request.header.sequence_number, 2u);
}

// The former process of a name dies and the next one sends a request within one tick. DDS reports the death by name
// alone.
TEST(ClientRequests, ADeathBelongsToTheFormerWriterIfAnotherWriterSendsAlready) {
  ArbiterState state;
  Arbiter(state).decide_client(request("pilot", kOperator, msg::kRequestTake, 1), writer(1));
  ClientRequests clients;
  clients.check_writers_with([](const WriterId& id) { return id == writer(2); });
  clients.add_death("pilot");
  clients.add(request("pilot", kOperator, msg::kRequestTake, 1), writer(2));
  const auto items = clients.latch(Arbiter(state).living());
  ASSERT_EQ(items.size(), 2u);
  EXPECT_FALSE(items[0].died);
  EXPECT_TRUE(items[1].died);
  EXPECT_EQ(items[1].writer, writer(1)) << "the death of the former process, by its writer";
  // Without a successor the death is the source's own.
  clients.add_death("pilot");
  clients.check_writers_with([](const WriterId&) { return true; });
  const auto last = clients.latch(Arbiter(state).living());
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].died);
}

// After a restart, `input` knows its sources from its checkpoint alone.
TEST(ClientRequests, AfterARestartAKnownSourceWithoutALivingWriterIsDead) {
  ArbiterState state;
  Arbiter(state).decide_client(request("pilot", kOperator, msg::kRequestTake, 1), writer(1));
  Arbiter(state).decide_client(request("x", kExternal, msg::kRequestTake, 1), writer(2));
  Arbiter(state).decide_client(request("unseen", kExternal, msg::kRequestTake, 1));
  ClientRequests after_restart;
  bool looking = true;
  after_restart.check_writers_with([&](const WriterId& id) { return looking || id == writer(2); });
  EXPECT_TRUE(after_restart.latch(Arbiter(state).living()).empty());
  looking = false;
  const auto items = after_restart.latch(Arbiter(state).living());
  ASSERT_EQ(items.size(), 1u);
  EXPECT_TRUE(items[0].died);
  EXPECT_EQ(items[0].source, "pilot");
  EXPECT_EQ(items[0].writer, writer(1));
}

TEST(UnansweredRequests, AreRepeatedUntilTheyAreAnsweredOrOutdated) {
  using namespace std::chrono_literals;
  UnansweredRequests unanswered;
  const auto start = std::chrono::steady_clock::time_point{};
  const auto repeated = [&](std::chrono::milliseconds at) {
    std::string numbers;
    unanswered.repeat(start + at, 500ms,
                      [&](const msg::Request& r) { numbers += std::to_string(r.header.sequence_number); });
    return numbers;
  };
  unanswered.asked(request("x", kExternal, msg::kRequestTake, 1), start);
  unanswered.asked(motion("x", kExternal, 2), start);
  unanswered.asked(motion("x", kExternal, 3), start + 100ms);
  EXPECT_EQ(repeated(400ms), "");
  EXPECT_EQ(repeated(600ms), "13");  // the second motion replaced the first
  EXPECT_EQ(repeated(700ms), "");
  unanswered.answered(1);
  EXPECT_EQ(repeated(1200ms), "3");
  unanswered.asked(request("x", kExternal, msg::kRequestEmergencyStop, 4), start + 1300ms);
  EXPECT_EQ(unanswered.stop(), 4u);
  EXPECT_EQ(repeated(2000ms), "4");  // no motion from before the stop
  unanswered.answered(4);
  EXPECT_EQ(unanswered.stop(), 0u);
  EXPECT_EQ(repeated(9000ms), "");
}

}  // namespace
}  // namespace constrictor
