// Programs that no launcher knows: those that hold the run's token may command the run from anywhere, others may only
// stop the robot. A plant can be stopped while `input` hangs.
#include <csignal>
#include <optional>
#include <stdexcept>

#include "client/request_client.hpp"
#include "client/source.hpp"
#include "cyclone/domain_claim.hpp"
#include "integration/run_watcher.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"
#include "support/command_lines.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// A program that sends commands to the run by itself, as one of another vendor would.
class Commander {
 public:
  explicit Commander(std::uint32_t number)
      : domain_(number),
        answers_(dds::Reader<msg::RunControlAnswer>::member(domain_.participant(), barrier_topics::kRunControlAnswer)),
        control_(domain_.participant(), barrier_topics::kRunControl) {}
  /// The refusal of a command; "" if it was obeyed, "no answer" if no answer came.
  std::string send(std::uint8_t command, const std::string& token, std::uint64_t run_id) {
    msg::RunControl message{};
    dds::set_text(message.source, "commander");
    dds::set_text(message.token, token);
    message.sequence_number = ++number_;
    message.run_id = run_id;
    message.command = command;
    message.seed = 1;
    std::string refusal = "no answer";
    bool answered = false;
    auto repeat_at = Clock::now();
    static_cast<void>(eventually([&] {
      if (Clock::now() >= repeat_at) {
        control_.write(message);
        repeat_at = Clock::now() + 300ms;
      }
      answers_.take([&](const msg::RunControlAnswer& answer) {
        if (answer.sequence_number != number_ || answer.source != std::string("commander")) return;
        answered = true;
        refusal = answer.refusal;
      });
      return answered;
    }));
    return refusal;
  }

 private:
  dds::Domain domain_;
  dds::Reader<msg::RunControlAnswer> answers_;
  dds::Writer<msg::RunControl> control_;
  std::uint64_t number_ = 0;
};

class Strangers : public CliFixture {
 protected:
  Strangers() {
    write("toys.yaml",
          case_study_manifest(
              10, "  - {components: [physics, navigation, control, planner, report], program: toy_host}\n"));
    write("blind.yaml", case_study_manifest(20, kBlindProcesses));
    fs::create_directory(elsewhere_);
  }
  [[nodiscard]] Process run_toys() {
    write("100000_ticks.yaml", "");
    Process launcher = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(),
                              "--report", (dir_ / "r").string(), "--pace", "1x"});
    EXPECT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
    return launcher;
  }
  [[nodiscard]] Process run_blind(const std::string& pace) {
    Process launcher =
        start({"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", pace});
    EXPECT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
    return launcher;
  }
  [[nodiscard]] fs::path in_registry(const std::string& end) const {
    return dir_ / "constrictor" / ("run-" + std::to_string(domain()) + end);
  }
  [[nodiscard]] nlohmann::json note() const { return nlohmann::json::parse(std::ifstream(in_registry(".json"))); }
  /// A command in the environment of another host: it finds no note of the run.
  int from_elsewhere(std::vector<std::string> arguments) {
    const auto own = std::exchange(environment_["XDG_RUNTIME_DIR"], elsewhere_.string());
    const int status = command(std::move(arguments));
    environment_["XDG_RUNTIME_DIR"] = own;
    return status;
  }
  [[nodiscard]] pid_t process_of(const std::string& component) const {
    for (const auto& [pid, line] : command_lines()) {
      if (line.find(dir_.string()) != std::string::npos && line.find("/bin/" + component + '\0') != std::string::npos)
        return pid;
    }
    return 0;
  }

  const fs::path elsewhere_ = dir_ / "elsewhere";
};

TEST_F(Strangers, OnlyTheTokenOfTheRunLetsAProgramCommandIt) {
  Process launcher = run_toys();
  const std::string token = note().at("token");
  const std::uint64_t run_id = note().at("run_id");
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(launcher.output().find(token), std::string::npos) << "a program on another host needs it";
  for (const char* end : {".json", ".token"}) {
    EXPECT_EQ(fs::status(in_registry(end)).permissions(), fs::perms::owner_read | fs::perms::owner_write) << end;
  }
  {
    Commander commander(domain());
    EXPECT_NE(commander.send(msg::kRunEnd, "", run_id).find("token: found none"), std::string::npos);
    EXPECT_NE(commander.send(msg::kRunEnd, std::string(32, 'f'), run_id).find("token: found another one"),
              std::string::npos);
    EXPECT_EQ(commander.send(msg::kRunEnd, token, run_id + 1), "run_id: of another run");
    EXPECT_TRUE(launcher.running());
    EXPECT_EQ(commander.send(msg::kRunPause, token, run_id), "");
    EXPECT_EQ(commander.send(msg::kRunResume, token, 0), "") << "a program need not know the run's id";
    EXPECT_EQ(commander.send(msg::kRunEnd, token, run_id), "");
  }
  ASSERT_TRUE(launcher.wait(20s).has_value());
  EXPECT_FALSE(fs::exists(dir_ / "constrictor" / "run-1.token"));
  for (const auto& entry : fs::directory_iterator(dir_ / "constrictor"))
    EXPECT_NE(entry.path().extension(), ".token") << entry.path();
}

TEST_F(Strangers, AnOperatorOnAnotherHostJoinsARunByItsDomain) {
  Process launcher = run_toys();
  const std::uint32_t number = domain();
  const std::string run = std::to_string(number);
  write("token", note().at("token").get<std::string>() + "\n");
  fs::permissions(dir_ / "token", fs::perms::owner_read | fs::perms::owner_write);
  const std::string file = (dir_ / "token").string();
  EXPECT_EQ(from_elsewhere({"status"}), exit_status::kSoftware) << "a domain must be named: " << output_;
  EXPECT_EQ(from_elsewhere({"status", "--run", run}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("navigation"), std::string::npos) << "the roster follows from the Hellos: " << output_;
  EXPECT_EQ(from_elsewhere({"pause", "--run", run}), exit_status::kSoftware) << output_;
  EXPECT_NE(output_.find("token: found none"), std::string::npos) << output_;
  EXPECT_EQ(from_elsewhere({"pause", "--domain", run, "--token-file", file}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("paused"), std::string::npos) << output_;
  EXPECT_EQ(from_elsewhere({"resume", "--domain", run, "--token-file", file}), exit_status::kOk) << output_;
  fs::permissions(dir_ / "token", fs::perms::owner_read | fs::perms::group_read);
  EXPECT_NE(from_elsewhere({"pause", "--domain", run, "--token-file", file}), exit_status::kOk);
  EXPECT_NE(output_.find("chmod 600"), std::string::npos) << output_;
  fs::permissions(dir_ / "token", fs::perms::owner_read);
  EXPECT_EQ(from_elsewhere({"end", "--run", run, "--token-file", file}), exit_status::kOk) << output_;
  EXPECT_TRUE(launcher.wait(20s).has_value());
  // The domain of the run is free again. It is claimed here, because a run of another test may take it otherwise.
  std::optional<DomainClaim> claim;
  ASSERT_TRUE(eventually(
      [&] {
        try {
          claim.emplace(number);
        } catch (const std::runtime_error&) {  // another run has it
        }
        return claim.has_value();
      },
      60s));
  EXPECT_EQ(from_elsewhere({"pause", "--run", run, "--token-file", file}), exit_status::kSoftware);
  EXPECT_NE(output_.find("no run in DDS domain " + run), std::string::npos) << output_;
}

// Only the plant's own stop can end this motion: no other component reads what the operator sends.
TEST_F(Strangers, APlantStopsWithoutATokenWhileInputHangs) {
  Process launcher = run_blind("realtime");
  const std::string run = std::to_string(domain());
  Watcher watcher(domain());
  Process teleop = start({"teleop", "--drive", "0.5,0.2"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  ASSERT_TRUE(eventually([&] {
    watcher.poll();
    const std::int64_t newest = watcher.joints.empty() ? 0 : watcher.joints.back().header.tick;
    return newest > 60 && widest_range(watcher, newest - 50, newest) > 0.2;
  }));
  const pid_t input = process_of("input");
  ASSERT_GT(input, 0);
  ASSERT_EQ(::kill(input, SIGSTOP), 0);
  EXPECT_EQ(from_elsewhere({"stop", "--run", run}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("emergency stop: the robot holds"), std::string::npos) << output_;
  {
    const dds::Reader<msg::StopState> stops =
        dds::Reader<msg::StopState>::member(watcher.participant(), std::string(topics::kStopState.name));
    std::optional<msg::StopState> stop;
    EXPECT_TRUE(eventually([&] {
      stops.take([&](const msg::StopState& state) { stop = state; });
      return stop && stop->stopped;
    }));
    EXPECT_TRUE(std::string(stop->source).starts_with("operator.")) << stop->source;
    // The joints come to rest, although control still sends the commands of the drive.
    const std::int64_t rest = stop->since_tick + 25;
    ASSERT_TRUE(eventually([&] {
      watcher.poll();
      return !watcher.joints.empty() && watcher.joints.back().header.tick > rest + 50;
    }));
    EXPECT_LT(widest_range(watcher, rest, rest + 50), 0.02);
    EXPECT_GT(widest_range(watcher, stop->since_tick - 50, stop->since_tick), 0.1) << "the robot moved before";
    ::kill(input, SIGCONT);
    ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityEmergencyStop)) << "input follows when it goes on";
  }
  EXPECT_EQ(teleop.wait(20s), exit_status::kFailed) << "authority was lost";
  EXPECT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"release"}), exit_status::kOk) << output_;
  Process again = start({"teleop", "--drive", "0.5,0.2"});
  EXPECT_TRUE(again.wait_for("driving", 20s)) << again.errors();
  EXPECT_TRUE(watcher.moves()) << "the plant obeys again";
  again.signal(SIGINT);
  EXPECT_EQ(again.wait(10s), 128 + SIGINT);
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_TRUE(launcher.wait(20s).has_value());
}

// A client with a wrong token is refused by `input` with the reason; its emergency stop is obeyed.
TEST_F(Strangers, ARequestWithoutTheTokenIsRefusedUnlessItIsAStop) {
  Process launcher = run_blind("1x");
  {
    RequestClientOptions options;
    options.source = unique_source("stranger");
    options.level = msg::kAuthorityOperator;
    options.key = RunKey{0, "guessed"};
    RequestClient client(domain(), options);
    client.connect_or_throw();
    EXPECT_EQ(client.wait_for_answer(client.ask(msg::kRequestTake), 10s), RequestClient::Answer::kRefused);
    EXPECT_NE(client.refusal().find("token: found another one"), std::string::npos) << client.refusal();
    EXPECT_FALSE(client.holds_authority());
    EXPECT_EQ(client.wait_for_answer(client.ask(msg::kRequestEmergencyStop), 10s), RequestClient::Answer::kGranted);
    EXPECT_EQ(client.wait_for_answer(client.ask(msg::kRequestClearStop), 10s), RequestClient::Answer::kRefused);
    EXPECT_TRUE(client.authority()->emergency_stop);
  }
  EXPECT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"topic", "echo", "authority", "--count", "1"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_TRUE(launcher.wait(20s).has_value());
}

}  // namespace
}  // namespace constrictor::testing
