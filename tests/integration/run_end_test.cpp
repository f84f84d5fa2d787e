// Early ends: a process that receives SIGTERM while it starts or while the run goes on, and a request to end the run
// before the run has begun. Also: which requests to the conductor are refused.
#include <csignal>
#include <iterator>
#include <optional>

#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
namespace wire = barrier_topics;

/// True if the process has several threads. It has them as soon as it begins to set up DDS.
bool has_threads(pid_t pid) {
  std::error_code gone;
  const fs::directory_iterator tasks("/proc/" + std::to_string(pid) + "/task", gone);
  return !gone && std::distance(begin(tasks), end(tasks)) > 1;
}

class RunEnd : public CliFixture {
 protected:
  /// Starts a process that hosts the toy components `names`, in the test's own domain.
  [[nodiscard]] Process toys(const std::string& names, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {program("toy_host"), names,
                                          "--domain",          std::to_string(claim_.domain()),
                                          "--roster",          "physics,control,report",
                                          "--scenario",        "50",
                                          "--robot",           ""};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments), environment_);
  }
  const DomainClaim claim_;
};

TEST_F(RunEnd, SigtermToThePlantEndsTheRunWithAnErrorThatNamesIt) {
  write(
      "toys.yaml",
      case_study_manifest(
          60,
          "  - {components: [physics], program: toy_host}\n  - {components: [navigation, control], program: toy_host}\n"
          "  - {components: [report], program: toy_host}\n"));
  write("100000_ticks.yaml", "");
  Process launcher = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(),
                            "--report", (dir_ / "r").string(), "--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("run ", 20s)) << launcher.errors();
  pid_t plant = 0;
  {
    const dds::Domain participant(domain());
    const auto statuses = dds::Reader<msg::ComponentStatus>::member(participant.participant(), wire::kStatus);
    ASSERT_TRUE(eventually([&] {
      statuses.take([&](const msg::ComponentStatus& s) {
        if (s.component == std::string("physics") && s.tick >= 0) plant = s.pid;
      });
      return plant > 0;
    }));
  }
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(::kill(plant, SIGTERM), 0);
  EXPECT_EQ(launcher.wait(40s), exit_status::kSoftware) << launcher.output();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s) << "no process may wait for its patience of 60 s to end";
  EXPECT_NE(launcher.output().find("physics, the plant (pid " + std::to_string(plant) + "), ended before the run did"),
            std::string::npos)
      << launcher.output();
  EXPECT_EQ(report("r").value("success", true), false);
}

// The signal arrives while DDS starts, when the process has not yet created most of its DDS entities.
TEST_F(RunEnd, SigtermWhileAProcessStartsEndsItWithSuccess) {
  for (int i = 0; i < 5; ++i) {
    Process member = toys("control");
    ASSERT_TRUE(eventually([&] { return has_threads(member.pid()); })) << member.errors();
    member.signal(SIGTERM);
    ASSERT_EQ(member.wait(20s), exit_status::kOk) << member.errors();
  }
}

TEST_F(RunEnd, AnEndBeforeTheRunHasBegunIsRefused) {
  const dds::Domain outside(claim_.domain());
  const auto answers = dds::Reader<msg::RunControlAnswer>::member(outside.participant(), wire::kRunControlAnswer);
  const dds::Writer<msg::RunControl> control(outside.participant(), wire::kRunControl, 1);
  Process plant = toys("physics", {"--pace", "1"});
  ASSERT_TRUE(eventually([&] { return control.readers() > 0 && answers.writers() > 0; }));
  msg::RunControl end{};
  dds::set_text(end.source, "outside");
  end.sequence_number = 1;
  end.command = msg::kRunEnd;
  control.write(end);
  ASSERT_TRUE(plant.wait_for("run_control refused: end: the run has not begun", 20s)) << plant.errors();
  Process others = toys("control,report");
  std::optional<msg::RunControlAnswer> first;
  ASSERT_TRUE(eventually([&] {
    answers.take([&](const msg::RunControlAnswer& answer) {
      if (!first) first = answer;
    });
    return first.has_value();
  }));
  EXPECT_EQ(std::string(first->source), "outside");
  EXPECT_EQ(first->sequence_number, 1u);
  EXPECT_NE(std::string(first->refusal).find("has not begun"), std::string::npos) << first->refusal;
  EXPECT_EQ(plant.wait(30s), exit_status::kOk) << plant.errors();
  EXPECT_EQ(others.wait(30s), exit_status::kOk) << others.errors();
  EXPECT_NE(others.output().find("result"), std::string::npos)
      << "the report must end the run, not the refused request";
}

TEST_F(RunEnd, ImpossiblePacesAndOldSequenceNumbersAreRefusedAndARepeatedRequestGetsTheSameAnswer) {
  const dds::Domain outside(claim_.domain());
  const auto answers = dds::Reader<msg::RunControlAnswer>::member(outside.participant(), wire::kRunControlAnswer);
  const dds::Writer<msg::RunControl> control(outside.participant(), wire::kRunControl, 8);
  Process run = toys("physics,control,report", {"--pace", "0.01"});
  const auto answer = [&](std::uint8_t command, double pace, std::uint64_t number) {
    msg::RunControl message{};
    dds::set_text(message.source, "outside");
    message.sequence_number = number;
    message.command = command;
    message.pace = pace;
    control.write(message);
    std::optional<std::string> refusal;
    EXPECT_TRUE(eventually([&] {
      answers.take([&](const msg::RunControlAnswer& each) {
        if (each.source == std::string("outside") && each.sequence_number == number) refusal = each.refusal;
      });
      return refusal.has_value();
    })) << "no answer to number "
        << number;
    return refusal.value_or("no answer");
  };
  ASSERT_TRUE(eventually([&] { return control.readers() > 0 && answers.writers() > 0; }));
  EXPECT_EQ(answer(msg::kRunPace, 1e-12, 5), "pace: found 1e-12, accepted 0 or 0.001 to 1000");
  EXPECT_EQ(answer(msg::kRunPace, 0.001, 6), "");
  EXPECT_NE(answer(msg::kRunPace, 1.0, 4).find("found 4, accepted more than 6"), std::string::npos);
  EXPECT_EQ(answer(msg::kRunPace, 1e-12, 6), "") << "number 6 was answered before and must get the same answer";
  EXPECT_EQ(answer(msg::kRunPace, 1.0, 7), "");
  EXPECT_EQ(answer(msg::kRunEnd, 0.0, 8), "");
  EXPECT_EQ(run.wait(20s), exit_status::kOk) << run.errors();
}

TEST_F(RunEnd, APaceOutsideOfTheAcceptedRangeIsAUsageError) {
  for (const char* pace : {"1e-12", "0.0009", "1001", "fast", "-1"}) {
    Process member = toys("physics", {"--pace", pace});
    EXPECT_EQ(member.wait(20s), exit_status::kUsage) << pace;
    EXPECT_NE(member.errors().find("accepted 0 or 0.001 to 1000"), std::string::npos) << member.errors();
  }
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"run", "--pace", "1e-12x"}, {"pace", "1e-12x"}}) {
    EXPECT_EQ(command(wrong), exit_status::kUsage) << output_;
    EXPECT_NE(output_.find("0.001x to 1000x"), std::string::npos) << output_;
  }
}

}  // namespace
}  // namespace constrictor::testing
