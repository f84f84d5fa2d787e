// Run-time parameters with real processes: a change takes effect at its tick, whenever it was requested, in whichever
// processes the components run, and although the owner's process is killed.
#include <signal.h>

#include "cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

constexpr const char* kFrequency = "navigation.travel.speed_m_s";
constexpr const char* kRate = "control.wave.curvature_rate_1_ms";
constexpr const char* kMethod = "control.motion.travel.method";
constexpr int kTick = 300;

class RunTimeParameters : public CliFixture {
 protected:
  RunTimeParameters() {
    write("report.yaml", "max_sim_time_s: 10\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n");
    write("planned.yaml",
          "parameter_changes:\n  - {tick: 300, name: navigation.travel.speed_m_s, value: 0.9}\n"
          "  - {tick: 300, name: control.wave.curvature_rate_1_ms, value: 0.7}\n");
  }
  [[nodiscard]] Process begin(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {
        "run", "short", "--report", (dir_ / name).string(), "--config", "report=" + (dir_ / "report.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(std::move(arguments));
  }
  [[nodiscard]] std::string planned() const { return "input=" + (dir_ / "planned.yaml").string(); }
  /// Waits until the run has reached its time limit, and returns its report.
  [[nodiscard]] json end(const std::string& name, Process& run) const {
    const auto status = run.wait(120s);
    EXPECT_TRUE(status == exit_status::kOk || status == exit_status::kFailed)
        << name << " ended with " << status.value_or(-1) << ": " << run.output() << run.errors();
    json result = report(name);
    EXPECT_TRUE(result.contains("state_hash")) << name;
    return result;
  }
  /// Output of `constrictor ARGUMENTS --json`, which must exit with `status`.
  json ask(std::vector<std::string> arguments, int status = 0) {
    arguments.push_back("--json");
    Process process = start(std::move(arguments));
    EXPECT_EQ(process.wait(30s), status) << process.output() << process.errors();
    return json::parse(process.output(), nullptr, false);
  }
  [[nodiscard]] bool run_answers() {
    return eventually([&] { return domain() != 0 && command({"param", "get", kFrequency}) == 0; });
  }
  /// Process id of a component in this run.
  [[nodiscard]] pid_t pid_of(const std::string& name) const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string pid = entry.path().filename();
      if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      if (fs::path(line.substr(0, line.find('\0'))).filename() == name && line.find(dir_.string()) != std::string::npos)
        return std::stoi(pid);
    }
    return -1;
  }
};

TEST_F(RunTimeParameters, EqualChangesAtEqualTicksGiveEqualRunsInAnyProcessesAndThroughACrash) {
  Process plain = begin("plain", {"--in-process"});
  const json without = end("plain", plain);
  EXPECT_EQ(without["parameters"], json::array());

  Process one = begin("one", {"--in-process", "--config", planned()});
  const json reference = end("one", one);
  const std::string expected = reference["state_hash"];
  EXPECT_NE(expected, without["state_hash"]);
  ASSERT_EQ(reference["parameters"].size(), 2u);
  EXPECT_EQ(reference["parameters"][0],
            json::parse(R"({"sim_time_s": 6.0, "tick": 300, "name": "navigation.travel.speed_m_s", "value": 0.9, )"
                        R"("source": "input.yaml"})"));

  Process ten = begin("ten", {"--config", planned()});
  EXPECT_EQ(end("ten", ten)["state_hash"], expected);

  // The same changes, requested from the command line before their tick; control is killed after it.
  Process asked = begin("asked", {"--pace", "1x"});
  ASSERT_TRUE(run_answers()) << output_;
  const json answer = ask({"param", "set", kFrequency, "0.9", kRate, "0.7", "--at-tick", std::to_string(kTick)});
  ASSERT_EQ(answer.size(), 2u) << answer;
  EXPECT_EQ(answer[0]["effective_tick"], kTick);
  EXPECT_LT(answer[1]["accepted_tick"], kTick);
  const json waiting = ask({"param", "get", kRate});
  EXPECT_EQ(waiting["value"], waiting["default"]);
  EXPECT_EQ(waiting["pending"], (json{{"tick", kTick}, {"value", 0.7}}));
  json in_force;
  ASSERT_TRUE(eventually([&] {
    return !(in_force = ask({"param", "get", kRate}))["changed_tick"].is_null();
  })) << in_force;
  const pid_t control = pid_of("control");
  ASSERT_GT(control, 0);
  ASSERT_EQ(::kill(control, SIGKILL), 0);
  EXPECT_EQ(in_force["value"], 0.7);
  EXPECT_EQ(in_force["changed_tick"], kTick);
  EXPECT_EQ(ask({"param", "get", kFrequency})["changed_tick"], kTick);
  const json result = end("asked", asked);
  EXPECT_EQ(result["state_hash"], expected);
  for (const auto& process : result["processes"])
    EXPECT_EQ(process["restarts"], process["name"] == "control" ? 1 : 0) << process;
  ASSERT_EQ(result["parameters"].size(), 2u);
  EXPECT_EQ(result["parameters"][1]["name"], kRate);
  EXPECT_EQ(result["parameters"][1]["tick"], kTick);
}

TEST_F(RunTimeParameters, TheCommandListsSetsAndRefusesParameters) {
  write("long.yaml", "max_sim_time_s: 600\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n");
  Process run = start({"run", "short", "--in-process", "--pace", "1x", "--report", (dir_ / "run").string(), "--config",
                       "report=" + (dir_ / "long.yaml").string()});
  ASSERT_TRUE(run_answers()) << output_;
  EXPECT_NE(output_.find("0.63 m/s"), std::string::npos) << output_;
  EXPECT_NE(output_.find("accepted: 0.001 to 2 m/s; default: 0.63 m/s"), std::string::npos) << output_;

  const json all = ask({"param", "list"});
  std::map<std::string, int> owners;
  for (const auto& p : all) {
    ++owners[p["owner"]];
    EXPECT_EQ(p["name"].get<std::string>().rfind(p["owner"].get<std::string>() + ".", 0), 0u);
    EXPECT_EQ(p["value"], p["default"]) << p;
    EXPECT_FALSE(p["doc"].get<std::string>().empty());
  }
  EXPECT_EQ(owners.size(), 4u) << all;
  EXPECT_EQ(ask({"param", "list", "perception.blob."}).size(), 2u);
  EXPECT_EQ(ask({"param", "list", "--changed"}), json::array());
  ASSERT_EQ(command({"param", "list"}), 0) << output_;
  const std::size_t column = output_.find("accepted");
  std::istringstream rows(output_.substr(output_.find('\n') + 1));
  std::size_t shown = 0;
  for (std::string row; std::getline(rows, row); ++shown) {
    double low = 0.0, high = 0.0;
    ASSERT_GT(row.size(), column) << row;
    EXPECT_EQ(row[column - 1], ' ') << "not below the heading: " << row;
    int names = 0;
    EXPECT_TRUE(std::sscanf(row.c_str() + column, "%lf to %lf", &low, &high) == 2 ||
                std::sscanf(row.c_str() + column, "one of %d names", &names) == 1)
        << "not below the heading: " << row;
  }
  EXPECT_EQ(shown, all.size());
  EXPECT_EQ(command({"param", "list", "nosuch"}), 1);
  EXPECT_EQ(output_, "param: no parameter begins with 'nosuch' (`constrictor param list` lists all)\n");
  EXPECT_EQ(command({"param", "list", "control.motoin"}), 1);
  EXPECT_NE(output_.find("'control.motoin', did you mean 'control.motion'? ("), std::string::npos) << output_;
  EXPECT_EQ(command({"param", "list", "--names", "control.squeeze"}), 0);
  EXPECT_EQ(output_, "control.squeeze.opening_share\ncontrol.squeeze.rate_rad_s\n");

  EXPECT_EQ(command({"param", "set", kFrequency, "0.9"}), 0) << output_;
  EXPECT_NE(output_.find("navigation.travel.speed_m_s: 0.9 from tick "), std::string::npos) << output_;
  ASSERT_TRUE(eventually([&] { return ask({"param", "get", kFrequency})["value"] == 0.9; }));
  EXPECT_EQ(ask({"param", "list", "--changed"}).size(), 1u);
  EXPECT_EQ(command({"param", "list"}), 0);
  EXPECT_NE(output_.find("* navigation.travel.speed_m_s"), std::string::npos) << output_;

  ASSERT_EQ(command({"completion", "bash"}), 0);
  write("completion.sh", output_ + "\nconstrictor() { \"" + program("constrictor") + "\" \"$@\"; }\n" +
                             "COMP_WORDS=(constrictor param get control.squeeze.r) COMP_CWORD=3\n_constrictor\necho "
                             "\"${COMPREPLY[@]}\"\n");
  Process bash({"/bin/bash", (dir_ / "completion.sh").string()}, environment_);
  EXPECT_EQ(bash.wait(30s), 0) << bash.errors();
  EXPECT_EQ(bash.output(), "control.squeeze.rate_rad_s\n") << bash.errors();

  // A refused value ends the command with the reason and status 1; later values are not requested.
  EXPECT_EQ(command({"param", "set", kFrequency, "2.5", kRate, "3"}), 1);
  EXPECT_NE(output_.find("refused: navigation.travel.speed_m_s: found 2.5, accepted 0.001 to 2 m/s"), std::string::npos)
      << output_;
  EXPECT_EQ(ask({"param", "set", "navigation.nothing", "1"}, 1)[0]["refused"].get<std::string>().find(
                "no component announces a parameter 'navigation.nothing'"),
            0u);
  EXPECT_EQ(command({"param", "set", "navigation.nothing", "1"}), 1);
  EXPECT_EQ(output_.find("param: refused: no component announces a parameter 'navigation.nothing'"), 0u) << output_;
  EXPECT_EQ(command({"param", "set", "navigation.travel.sped_m_s", "1"}), 1);
  EXPECT_NE(output_.find("did you mean 'navigation.travel.speed_m_s'?"), std::string::npos) << output_;
  // One that the next run can have, with a number, with a text, and to be read.
  for (const std::vector<std::string>& fixed : {std::vector<std::string>{"set", "report.settle_s", "3"},
                                                {"set", "report.settle_s", "long"},
                                                {"get", "report.settle_s"}}) {
    std::vector<std::string> arguments = {"param"};
    arguments.insert(arguments.end(), fixed.begin(), fixed.end());
    EXPECT_EQ(command(arguments), 1) << output_;
    EXPECT_NE(output_.find("cannot change while the run goes on; accepted in a configuration file"), std::string::npos)
        << output_;
  }
  EXPECT_EQ(command({"param", "set", kFrequency, "0.8", "--at-tick", "1"}), 1);
  EXPECT_NE(output_.find("found 1, accepted "), std::string::npos) << output_;
  EXPECT_EQ(command({"param", "set", "navigation.line_tracker.lost_after_images", "3.5"}), 1);
  EXPECT_NE(output_.find("accepted whole numbers from 1 to 100"), std::string::npos) << output_;
  EXPECT_EQ(ask({"param", "list", "--changed"}).size(), 1u);

  // A parameter that is chosen by name.
  EXPECT_EQ(ask({"param", "get", kMethod})["value"], "undulation");
  EXPECT_EQ(command({"param", "set", kMethod, "moonwalk"}), exit_status::kUsage);
  EXPECT_NE(output_.find("found 'moonwalk', accepted one of undulation, sidewinding, "), std::string::npos) << output_;
  EXPECT_EQ(command({"param", "set", kMethod, "sidewindig"}), exit_status::kUsage);
  EXPECT_NE(output_.find(", did you mean 'sidewinding'?"), std::string::npos) << output_;
  EXPECT_EQ(command({"param", "set", kMethod, "sidewinding", kFrequency, "0.8"}), 0) << output_;
  EXPECT_NE(output_.find("control.motion.travel.method: sidewinding from tick "), std::string::npos) << output_;
  ASSERT_TRUE(eventually([&] { return ask({"param", "get", kMethod})["value"] == "sidewinding"; }));
  EXPECT_EQ(command({"param", "set", kMethod, "99"}), 1);
  EXPECT_NE(output_.find("found 99, accepted the number of one of undulation, "), std::string::npos) << output_;

  // Wrong usage.
  EXPECT_EQ(command({"param", "set", kFrequency}), exit_status::kUsage);
  EXPECT_EQ(command({"param", "set", kFrequency, "fast"}), exit_status::kUsage);
  EXPECT_EQ(command({"param", "set", kFrequency, "0.9", kRate}), exit_status::kUsage);
  EXPECT_EQ(command({"param", "get", "navigation.nothing"}), 1);
  EXPECT_EQ(command({"param"}), exit_status::kUsage);
  EXPECT_EQ(command({"param", "list", "--names", "--json"}), exit_status::kUsage);

  // With --json, scripts read from standard output why nothing was done.
  EXPECT_EQ(ask({"param", "get", "navigation.travel.speed"}, 1),
            (json{{"name", "navigation.travel.speed"},
                  {"refused",
                   "no parameter 'navigation.travel.speed', did you mean 'navigation.travel.speed_m_s'?"
                   " (`constrictor param list` lists all)"}}));
  const auto refusal = [&](std::vector<std::string> arguments, int status) {
    const json answer = ask(std::move(arguments), status);
    return answer.is_array() && answer.size() == 1 ? answer[0].value("refused", "") : answer.dump();
  };
  write("wrong.yaml", "navigation: {travel: {speed_m_s: 99}}\n");
  const std::string wrong = refusal({"param", "load", (dir_ / "wrong.yaml").string()}, exit_status::kConfiguration);
  EXPECT_NE(wrong.find("found 99"), std::string::npos) << wrong;
  EXPECT_NE(refusal({"param", "set", kFrequency, "fast"}, exit_status::kUsage).find("found 'fast'"), std::string::npos);
  EXPECT_NE(refusal({"param", "load", "/nosuch.yaml"}, exit_status::kConfiguration).find("cannot be read"),
            std::string::npos);

  // Input answers in its next step, which a paused run does not make.
  EXPECT_EQ(command({"pause"}), 0) << output_;
  const json silent = ask({"param", "set", kFrequency, "0.6"}, exit_status::kWaitedTooLong);
  ASSERT_EQ(silent.size(), 1u) << silent;
  EXPECT_EQ(silent[0]["name"], kFrequency);
  EXPECT_EQ(silent[0]["no_answer"].get<std::string>().find("no answer within 5 s"), 0u) << silent;
  EXPECT_EQ(command({"resume"}), 0) << output_;

  // A reset restores the defaults.
  EXPECT_EQ(command({"reset", "1"}), 0) << output_;
  json after;
  EXPECT_TRUE(eventually([&] { return (after = ask({"param", "get", kFrequency}))["changed_tick"].is_null(); }));
  EXPECT_EQ(after["value"], 0.63) << after;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(RunTimeParameters, TheExitStatusShowsThatThereIsNoRun) {
  EXPECT_EQ(command({"param", "list"}), exit_status::kSoftware);
  EXPECT_EQ(command({"param", "set", kFrequency, "0.9"}), exit_status::kSoftware);
  EXPECT_NE(ask({"param", "get", kFrequency}, exit_status::kSoftware).value("refused", "").find("no run"),
            std::string::npos);
  EXPECT_EQ(command({"param", "--help"}), 0);
  EXPECT_NE(output_.find("EXAMPLES"), std::string::npos);
}

TEST_F(RunTimeParameters, ARunWithoutInputIsNamedAlsoInJson) {
  write("no_input.yaml", case_study_manifest(20, "  - {components: [physics, control]}\n"));
  Process run = start(
      {"run", "--manifest", (dir_ / "no_input.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "1x"});
  ASSERT_TRUE(run.wait_for("simulated", 30s)) << run.output() << run.errors();
  const json answer = ask({"param", "set", kFrequency, "0.9"}, exit_status::kWaitedTooLong);
  ASSERT_EQ(answer.size(), 1u) << answer;
  EXPECT_NE(answer[0]["refused"].get<std::string>().find("input"), std::string::npos) << answer;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

}  // namespace
}  // namespace constrictor::testing
