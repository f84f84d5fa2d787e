// Attacks on a run from another participant, without DDS Security: the token and the announced writers must
// prevent forged messages from changing the result, and messages of strangers may cost only little memory and few log
// lines. The figures are in tests/README.md.
#include <numeric>

#include "integration/attacked_run.hpp"
#include "integration/attacker.hpp"

namespace constrictor::testing {
namespace {

class Attacks : public AttackedRun {
 protected:
  /// Of the run, which has twice the pace of real time.
  [[nodiscard]] virtual long ticks() const { return 400; }

  void SetUp() override {
    Process reference = run(ticks(), "reference", {"--in-process"});
    ASSERT_EQ(reference.wait(60s), exit_status::kOk) << reference.errors();
    launcher_.emplace(run(ticks(), "attacked", {"--pace", "2x"}));
    domain_ = domain_of(*launcher_);
    ASSERT_GT(domain_, 0u) << launcher_->errors();
    attacker_.emplace(domain_);
    ASSERT_TRUE(attacker_->ready_to_forge(5)) << launcher_->output() << launcher_->errors();
  }
  /// Ends the test: the run must have the result of the run that was left alone.
  void expect_same_result() {
    attacker_->poll();
    ASSERT_EQ(launcher_->wait(60s), exit_status::kOk) << launcher_->output() << launcher_->errors();
    EXPECT_EQ(state_hash("attacked"), state_hash("reference"));
    EXPECT_NE(state_hash("reference"), "none");
    for (const auto& process : report("attacked").at("processes")) EXPECT_EQ(process.at("restarts"), 0) << process;
    expect_nobody_left();
  }

  unsigned domain_ = 0;
  std::optional<Process> launcher_;
  std::optional<Attacker> attacker_;
};

TEST_F(Attacks, ForgedAndReplayedMessagesOfMembersDoNotChangeTheRun) {
  Attacker& attacker = *attacker_;
  const std::uint64_t forged = attacker.forge_control(msg::kRunEnd, "");
  const std::uint64_t guessed = attacker.forge_control(msg::kRunEnd, std::string(32, '0'));
  attacker.forge_control(msg::kRunReset, std::string(64, 'f'));
  EXPECT_TRUE(eventually([&] {
    attacker.poll();
    return attacker.answers.contains(forged) || attacker.answers.contains(guessed);
  })) << "a refused command is answered";
  for (const auto& [number, refusal] : attacker.answers) EXPECT_NE(refusal.find("token: found"), std::string::npos);
  for (const std::string name : {"physics", "navigation", "control", "planner", "report"}) {
    for (const std::uint32_t incarnation : {1u, 2u, 1000u}) {
      attacker.forge_hello(name, incarnation);
      for (const std::int64_t ahead : {-1, 0, 1, 1000}) attacker.forge_done(name, incarnation, ahead, true);
    }
    msg::Refused refusal{};
    dds::set_text(refusal.component, name);
    refusal.run_id = attacker.state->run_id;
    refusal.incarnation = 1;
    refusal.pid = attacker.known.at(name).pid;
    dds::set_text(refusal.host, attacker.known.at(name).host);
    attacker.refused.write(refusal);
  }
  msg::EpochStart start{};
  start.run_id = attacker.state->run_id;
  start.epoch = attacker.state->epoch + 1;
  start.seed = 99;
  dds::set_text(start.config_hash, attacker.known.at("navigation").config_hash);
  attacker.start.write(start);
  for (const std::int64_t ahead : {-1, 0, 1, 2, 100}) {
    attacker.forge_tick(ahead, false);
    attacker.forge_tick(ahead, true);
  }
  for (int i = 0; i < 50; ++i) {
    attacker.poll();
    for (const std::uint64_t ahead : {1, 2, 3, 100}) {
      attacker.forge_joint_command(ahead, 1);
      attacker.forge_joint_command(ahead, 1000);
    }
    static_cast<void>(eventually([] { return false; }, 10ms));
  }
  const auto log = log_size("attacked");
  expect_same_result();
  std::printf("forged messages: same result, logs of %ju bytes\n", log);
}

/// The run goes on for 40 s unless it is told to hurry.
class LongAttack : public Attacks {
 protected:
  [[nodiscard]] long ticks() const override { return 4000; }
};

// Half of them name no component of the roster, the others a member with ever higher incarnations.
TEST_F(LongAttack, FiftyThousandHellosCostNeitherMemoryNorLogLinesNorAnswers) {
  Attacker& attacker = *attacker_;
  const auto refused = dds::Reader<msg::Refused>::member(attacker.get(), wire::kRefused);
  const auto flood = [&](int from) {
    std::size_t answers = 0;
    for (int i = from; i < from + 50'000; ++i) {
      msg::Hello message = attacker.known.at("navigation");
      dds::set_text(message.component, i % 2 == 0 ? "stranger_" + std::to_string(i) : "navigation");
      message.incarnation = 1000 + static_cast<std::uint32_t>(i);
      attacker.hello.write(message);
      refused.take([&](const msg::Refused&) { ++answers; });
    }
    dds_wait_for_acks(attacker.hello.get(), DDS_SECS(20));
    return answers;
  };
  // On a busy machine, thousands of messages wait in each process, whose heap does not shrink afterwards. What is kept
  // for good costs memory each time.
  flood(0);
  const long before_kib = memory_kib();
  const auto log_before = log_size("attacked");
  const auto began = std::chrono::steady_clock::now();
  const std::size_t answers = flood(50'000);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const long grown_kib = memory_kib() - before_kib;
  const auto logged = log_size("attacked") - log_before;
  ASSERT_TRUE(launcher_->running()) << "the memory of processes that have ended says nothing";
  std::printf("50000 Hellos in %.1f s: memory of 5 processes %+ld KiB, logs %ju bytes, %zu answers\n", wall_s,
              grown_kib, logged, answers);
  // For comparison: a participant that keeps 25,000 instances of Hello needs about 20 MB, in each process.
  EXPECT_LT(grown_kib, 20'000);
  EXPECT_LT(logged, 100'000u);
  EXPECT_LT(answers, 16 + 10 * static_cast<std::size_t>(wall_s + 1));
  Process hurry = command({"pace", "lockstep", "--run", std::to_string(domain_)});
  EXPECT_EQ(hurry.wait(20s), exit_status::kOk) << hurry.errors();
  expect_same_result();
}

TEST_F(Attacks, CommandsAndStopsFromManySourcesCostLittle) {
  Attacker& attacker = *attacker_;
  const long before_kib = memory_kib();
  for (int i = 0; i < 20'000; ++i) {
    msg::RunControl message{};
    dds::set_text(message.source, "source_" + std::to_string(i));
    message.sequence_number = 1;
    message.command = msg::kRunEnd;
    attacker.control.write(message);
    msg::EmergencyStop stop{};
    stop.robot_id = 1;
    dds::set_text(stop.source, "source_" + std::to_string(i));
    attacker.stop.write(stop);
  }
  dds_wait_for_acks(attacker.control.get(), DDS_SECS(20));
  const long grown_kib = memory_kib() - before_kib;
  std::printf("20000 commands and stops from 20000 sources: memory of 5 processes %+ld KiB\n", grown_kib);
  EXPECT_LT(grown_kib, 20'000);
  expect_same_result();
}

}  // namespace
}  // namespace constrictor::testing
