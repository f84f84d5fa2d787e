// Commands to a conductor that answers late, refuses or is not there.
#include "client/run_control_client.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kRunId = 7;

/// Answers each command when it has arrived `arrivals` times.
class FakeConductor {
 public:
  FakeConductor(std::int32_t participant, int arrivals, std::string refusal)
      : commands_(dds::Reader<msg::RunControl>::member(participant, barrier_topics::kRunControl)),
        answers_(participant, barrier_topics::kRunControlAnswer, 64),
        thread_([this, arrivals, refusal = std::move(refusal)] {
          for (std::uint64_t number = 0, count = 0; !end_; std::this_thread::sleep_for(1ms)) {
            commands_.take([&](const msg::RunControl& command) {
              count = command.sequence_number == number ? count + 1 : 1;
              number = command.sequence_number;
              if (count < static_cast<std::uint64_t>(arrivals)) return;
              obeyed_ += count == static_cast<std::uint64_t>(arrivals) ? 1 : 0;
              msg::RunControlAnswer answer{};
              dds::set_text(answer.source, command.source);
              answer.sequence_number = command.sequence_number;
              dds::set_text(answer.refusal, refusal);
              answer.state.run_id = kRunId;
              answer.state.tick = 40;
              answer.state.seed = command.seed;
              answer.state.pace = command.pace;
              answer.state.paused = command.command == msg::kRunPause;
              answers_.write(answer);
            });
          }
        }) {}
  ~FakeConductor() {
    end_ = true;
    thread_.join();
  }
  [[nodiscard]] int obeyed() const { return obeyed_; }

 private:
  dds::Reader<msg::RunControl> commands_;
  dds::Writer<msg::RunControlAnswer> answers_;
  std::atomic<bool> end_ = false;
  std::atomic<int> obeyed_ = 0;
  std::thread thread_;
};

struct RunControlClientTest : ::testing::Test {
  const DomainClaim claim;
  const dds::Domain domain{claim.domain()};
  RunControlClient client(std::chrono::seconds bound, std::function<bool()> interrupted = {}) const {
    return RunControlClient(domain.participant(), claim.domain(), bound, std::move(interrupted));
  }
};

TEST_F(RunControlClientTest, RepeatsACommandUntilItIsAnswered) {
  const FakeConductor conductor(domain.participant(), 3, "");
  RunControlClient control = client(20s);
  EXPECT_TRUE(control.pause().paused);
  EXPECT_EQ(control.reset(7).seed, 7u);
  EXPECT_EQ(control.set_pace(2.5).pace, 2.5);
  EXPECT_EQ(conductor.obeyed(), 3);
}

TEST_F(RunControlClientTest, ThrowsTheReasonOfARefusal) {
  const FakeConductor conductor(domain.participant(), 1, "the run has not begun");
  try {
    client(20s).end();
    FAIL() << "a refused command must throw";
  } catch (const CommandError& error) {
    EXPECT_EQ(error.cause(), CommandError::Cause::kRefused);
    EXPECT_STREQ(error.what(), "the run has not begun");
  }
}

TEST_F(RunControlClientTest, WithoutAConductorItThrowsAfterTheBoundAndNamesTheRun) {
  try {
    client(1s).resume();
    FAIL() << "a command without an answer must throw";
  } catch (const CommandError& error) {
    EXPECT_EQ(error.cause(), CommandError::Cause::kNoAnswer);
    EXPECT_NE(std::string(error.what()).find("run " + std::to_string(claim.domain())), std::string::npos);
  }
}

TEST_F(RunControlClientTest, AStepDoesNotCountTheTicksOfAnotherRun) {
  const FakeConductor conductor(domain.participant(), 1, "");
  const dds::Writer<msg::RunState> states(domain.participant(), barrier_topics::kRunState);
  msg::RunState state{};
  state.run_id = kRunId + 1;
  state.tick = 1000;
  states.write(state);
  std::atomic<int> looked = 0;  // how often the client has looked for answers and states
  RunControlClient control = client(20s, [&] { return ++looked, false; });
  std::atomic<bool> stepped = false;
  std::thread own([&] {
    EXPECT_TRUE(testing::eventually([&] { return conductor.obeyed() == 2; }));  // pause and step
    const int before = looked;
    EXPECT_TRUE(testing::eventually([&] { return stepped || looked >= before + 5; }));
    EXPECT_FALSE(stepped) << "the tick of another run ended the wait";
    state.run_id = kRunId;
    state.tick = 45;
    states.write(state);
  });
  EXPECT_EQ(control.step(5).tick, 45);
  stepped = true;
  own.join();
}

// A tick every 200 ms: the steps last longer than the bound of an answer, within which there must be a tick.
TEST_F(RunControlClientTest, StepsMayLastLongerThanTheBoundWhileTicksAdvance) {
  constexpr auto kBound = 2s;
  constexpr std::int64_t kSteps = 12;
  const FakeConductor conductor(domain.participant(), 1, "");
  const dds::Writer<msg::RunState> states(domain.participant(), barrier_topics::kRunState);
  RunControlClient control = client(kBound);
  std::thread run([&] {
    EXPECT_TRUE(testing::eventually([&] { return conductor.obeyed() == 2; }));  // pause and step
    msg::RunState state{};
    state.run_id = kRunId;
    for (state.tick = 41; state.tick <= 40 + kSteps; ++state.tick) {
      std::this_thread::sleep_for(200ms);  // the pace of this run
      states.write(state);
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(control.step(kSteps).tick, 40 + kSteps);
  EXPECT_GT(std::chrono::steady_clock::now() - begin, kBound);
  run.join();
}

TEST_F(RunControlClientTest, AnInterruptEndsTheWait) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    client(60s, [&] { return std::chrono::steady_clock::now() - begin > 50ms; }).pause();
    FAIL() << "a command without an answer must throw";
  } catch (const CommandError& error) {
    EXPECT_EQ(error.cause(), CommandError::Cause::kInterrupted);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s);
}

}  // namespace
}  // namespace constrictor
