// Errors that `constrictor run` reports before it starts a process, and the commands `check` and `list`.
#include <sstream>

#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

TEST_F(RunCommand, RefusesWrongFilesAndArgumentsBeforeAnythingStarts) {
  struct Case {
    std::vector<std::string> options;
    int status;
    std::string said;
  };
  write("typo.yaml", replaced(kManifest, "plant:", "plannt:"));
  write("missing.yaml", replaced(kManifest, "[planner], program: toy_host", "[planner], program: no_such_program"));
  write("unknown.yaml", replaced(kManifest, "[planner], program: toy_host", "[plannr]"));
  write("robot.yaml", "name: none\n");
  const auto file = [this](const char* name) { return (dir_ / name).string(); };
  fs::create_symlink("circle.yaml", dir_ / "circle.yaml");  // a symbolic link to itself
  const std::vector<Case> cases = {
      {{"--manifest", file("typo.yaml")}, exit_status::kConfiguration, "typo.yaml:1"},
      {{"--manifest", file("missing.yaml")}, exit_status::kConfiguration, "no_such_program"},
      {{"--manifest", file("unknown.yaml")}, exit_status::kConfiguration, "did you mean 'planner'?"},
      {{"nowhere"}, exit_status::kConfiguration, "scenario: found 'nowhere'"},
      {{"--robot", file("robot.yaml")}, exit_status::kConfiguration, "robot.yaml:1: module: "},
      {{"--config", "nav=" + file("robot.yaml")}, exit_status::kConfiguration, "did you mean 'navigation'?"},
      {{"--config", "navigation=missing"},
       exit_status::kConfiguration,
       "configuration: --config navigation: found no file"},
      {{"--config", "navigation=" + file("robot.yaml")},
       exit_status::kConfiguration,
       "navigation: " + file("robot.yaml")},
      {{"--secure", file("no_keys")}, exit_status::kConfiguration, "--secure: found no folder " + file("no_keys")},
      {{"--robot", file("circle.yaml")}, exit_status::kConfiguration, "robot: found '" + file("circle.yaml")},
      {{"--pace", "fast"}, exit_status::kUsage, "--pace: found 'fast'"},
      {{"--seed", "18446744073709551616"}, exit_status::kUsage, "found '18446744073709551616'"},
      {{"--max-sim-time", "nan"}, exit_status::kUsage, "found 'nan'"},
      {{"--sead", "3"}, exit_status::kUsage, "did you mean '--seed'?"},
  };
  for (const auto& [options, status, said] : cases) {
    std::vector<std::string> arguments = {"run", "--report", file("r")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Process refused = command(arguments);
    EXPECT_EQ(refused.wait(30s), status) << options.front() << refused.output() << refused.errors();
    EXPECT_NE(refused.errors().find(said), std::string::npos) << said << " in: " << refused.errors();
    EXPECT_FALSE(fs::exists(dir_ / "r")) << "no run directory may be made: " << options.front();
    EXPECT_EQ(refused.output(), "") << "no run may be started: " << options.front();
  }
}

TEST_F(RunCommand, AWrongOptionOfAHostedComponentIsExplained) {
  Process refused = command({"host", "navigation", "--domian", "3"});
  EXPECT_EQ(refused.wait(30s), exit_status::kUsage);
  EXPECT_EQ(refused.errors(),
            "navigation: no option '--domian', did you mean '--domain'? (see constrictor_host navigation --help)\n");
}

// The value of a shell's variable that is not set.
TEST_F(RunCommand, EveryCommandRefusesAnEmptyArgument) {
  const std::vector<std::vector<std::string>> commands = {
      {"run", "--secure", ""},    {"check", "--robot", ""},
      {"host", "--robot", ""},    {"conform", "planner", "--robot", ""},
      {"dashboard", "--run", ""}, {"camera", "show", "--source", ""}};
  for (const auto& arguments : commands) {
    Process refused = command(arguments);
    EXPECT_EQ(refused.wait(30s), exit_status::kUsage) << arguments.front() << refused.output() << refused.errors();
    EXPECT_NE(refused.errors().find("found nothing, accepted a value"), std::string::npos) << refused.errors();
  }
}

TEST_F(RunCommand, SaysWithoutTheWordsOfALibraryThatAReportCannotBeWritten) {
  Process refused = command({"run", "--report", "/dev/null"});
  EXPECT_EQ(refused.wait(30s), exit_status::kSoftware) << refused.errors();
  EXPECT_EQ(refused.errors(), "constrictor: /dev/null: Not a directory\n");
}

TEST_F(RunCommand, CheckReportsWhatRunWouldRefuseAndStartsNothing) {
  Process correct = command({"check", "line", "--robot", "serpens"});
  EXPECT_EQ(correct.wait(30s), exit_status::kOk) << correct.errors();
  EXPECT_NE(correct.output().find("no errors: "), std::string::npos) << correct.output();
  write("bad.yaml", "travel: 3\n");
  const std::string bad = (dir_ / "bad.yaml").string();
  Process wrong = command({"check", "--config", "planner=" + bad, "--config", "control=" + bad});
  EXPECT_EQ(wrong.wait(30s), exit_status::kConfiguration) << wrong.output();
  for (const char* component : {"planner", "control"}) {
    EXPECT_NE(wrong.errors().find(component + (": " + bad + ":")), std::string::npos)
        << "check must report all errors, not only the first: " << wrong.errors();
  }
  Process foreign = command({"check", "--manifest", (dir_ / "toys.yaml").string()});
  EXPECT_EQ(foreign.wait(30s), exit_status::kOk) << foreign.errors();
  EXPECT_NE(foreign.output().find("not checked: the configuration of planner"), std::string::npos) << foreign.output();
  EXPECT_FALSE(fs::exists("runs"));
}

TEST_F(RunCommand, RefusesASceneInWhichTheMissionCannotSucceed) {
  // mamba's U holds up to 0.119 m (components/navigation/README.md).
  const std::string scene =
      "line: {colour: blue, width_m: 0.05, begin_m: [0.3, 0.0], segments: [{length_m: 1.0}]}\n"
      "objects:\n"
      "  - {colour: green, position_m: [2.0, 0.0], shape: cylinder, radius_m: 0.1, height_m: 0.15, mass_kg: 0.4}\n"
      "  - {colour: red, position_m: [2.5, 0.0], shape: cylinder, radius_m: 0.13, height_m: 0.15, mass_kg: 0.4}\n"
      "  - {colour: yellow, position_m: [3.0, 0.0], shape: box, size_m: [0.19, 0.19, 0.15], mass_kg: 0.4}\n"
      "zones:\n"
      "  - {colour: green, position_m: [-1.0, 0.5], radius_m: 0.4}\n"
      "  - {colour: red, position_m: [-1.0, -0.5], radius_m: 0.1}\n"
      "  - {colour: yellow, position_m: [-2.0, 0.5], radius_m: 0.4}\n"
      "start: {position_m: [0.0, 0.0]}\n";
  const auto check = [&](const std::string& sequence) {
    write("scene.yaml", "name: scene\nmission: {line_colour: blue, sequence: " + sequence + "}\n" + scene);
    Process checked = command({"check", (dir_ / "scene.yaml").string()});
    const auto status = checked.wait(30s);
    return std::pair(status, checked.errors());
  };
  const auto [fits, silence] = check("[green]");
  EXPECT_EQ(fits, exit_status::kOk) << "the others are not demanded: " << silence;
  EXPECT_EQ(silence, "");
  const auto [accepted, warning] = check("[green, yellow]");
  EXPECT_EQ(accepted, exit_status::kOk) << warning;
  EXPECT_NE(warning.find("warning: " + (dir_ / "scene.yaml").string() + ": objects[2].size_m: found a diagonal of"),
            std::string::npos)
      << warning;
  const auto [status, errors] = check("[green, red]");
  EXPECT_EQ(status, exit_status::kConfiguration);
  for (const char* error :
       {"scene.yaml: objects[1].radius_m: found 0.130 m, accepted at most 0.119 m",
        "scene.yaml: zones[1].radius_m: found 0.100 m, accepted at least 0.130 m for objects[1]", "(seed 1; "})
    EXPECT_NE(errors.find(error), std::string::npos) << error << " in: " << errors;
}

TEST_F(RunCommand, RefusesARobotThatDoesNotMove) {
  std::ifstream from(source_path("components/lib/robot/mamba.yaml"));
  const std::string mamba{std::istreambuf_iterator<char>(from), {}};
  const std::string robot = (dir_ / "robot.yaml").string();
  const auto check = [&](const std::string& speed_rad_s) {
    write("robot.yaml", replaced(mamba, "max_speed_rad_s: 4.0", "max_speed_rad_s: " + speed_rad_s));
    Process checked = command({"check", "line", "--robot", robot});
    const auto status = checked.wait(30s);
    return std::pair(status, checked.errors());
  };
  const auto [refused, why] = check("0.1");
  EXPECT_EQ(refused, exit_status::kConfiguration);
  EXPECT_NE(why.find(robot + ": the robot mamba does not move: joints.max_speed_rad_s: found 0.1, accepted at least"),
            std::string::npos)
      << why;
  const auto [accepted, warning] = check("0.9");
  EXPECT_EQ(accepted, exit_status::kOk) << warning;
  EXPECT_NE(warning.find("warning: " + robot + ": the robot mamba hardly moves: joints.max_speed_rad_s"),
            std::string::npos)
      << warning;
  const auto [moves, silence] = check("4.0");
  EXPECT_EQ(moves, exit_status::kOk) << silence;
  EXPECT_EQ(silence, "");
}

TEST_F(RunCommand, EvaluateCountsRefusedDrawsApart) {
  std::ifstream from(source_path("sim/scenarios/wide.yaml"));
  const std::string text{std::istreambuf_iterator<char>(from), {}};
  write("wider.yaml", replaced(text, "radius: 0.41", "radius: 0.7"));
  // Of seeds 3 and 4, 3 draws an object that is too large.
  const std::vector<std::string> arguments{"evaluate", (dir_ / "wider.yaml").string(), "--max-sim-time", "0.2",
                                           "--output", (dir_ / "e").string(),          "--seeds",        "3,4"};
  for (const char* time : {"the first time", "continued"}) {
    Process evaluation = command(arguments);
    EXPECT_EQ(evaluation.wait(60s), exit_status::kConfiguration) << time << evaluation.output() << evaluation.errors();
    EXPECT_NE(evaluation.errors().find("1 of 2 runs refused"), std::string::npos) << evaluation.errors();
    EXPECT_EQ(evaluation.errors().find("the same command"), std::string::npos) << evaluation.errors();
    const auto summary = nlohmann::json::parse(read("e/summary.json")).at("variants").at(0);
    EXPECT_EQ(summary.at("errors"), 0);
    EXPECT_EQ(summary.at("refused"), 1);
    EXPECT_EQ(summary.at("runs"), 2);
  }
}

TEST_F(RunCommand, EvaluateNamesTheVariantThatIsRefused) {
  Process refused = command({"evaluate", "short", "--seeds", "1..40", "--vary", "robot:module.count=24,12", "--output",
                             (dir_ / "e").string()});
  EXPECT_EQ(refused.wait(60s), exit_status::kConfiguration) << refused.output();
  for (const char* text :
       {"--vary robot:module.count=12: ", "robot.yaml: the robot mamba cannot grasp: module.count: "})
    EXPECT_NE(refused.errors().find(text), std::string::npos) << text << " in: " << refused.errors();
}

TEST_F(RunCommand, EveryShippedManifestAndItsConfigurationsAreAccepted) {
  Process list = command({"list", "manifests", "--names"});
  ASSERT_EQ(list.wait(20s), exit_status::kOk) << list.errors();
  std::istringstream names(list.output());
  int count = 0;
  for (std::string name; std::getline(names, name); ++count) {
    Process check = command({"check", "--manifest", name});
    EXPECT_EQ(check.wait(30s), exit_status::kOk) << name << ": " << check.errors();
  }
  EXPECT_GT(count, 0);
}

TEST_F(RunCommand, ListNamesEverythingThatCanBeChosenByName) {
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"scenarios", "case_study"}, {"robots", "mamba"}, {"manifests", "manual"}, {"components", "navigation"}};
  for (const auto& [kind, name] : expected) {
    Process list = command({"list", kind, "--names"});
    EXPECT_EQ(list.wait(20s), exit_status::kOk) << list.errors();
    EXPECT_NE(("\n" + list.output()).find("\n" + name + "\n"), std::string::npos) << kind << ": " << list.output();
  }
  Process described = command({"list", "scenarios"});
  EXPECT_EQ(described.wait(20s), exit_status::kOk);
  EXPECT_NE(described.output().find("case_study    "), std::string::npos) << described.output();
  Process wrong = command({"list", "scenario"});
  EXPECT_EQ(wrong.wait(20s), exit_status::kUsage);
}

TEST_F(RunCommand, AScriptReadsAsJsonWhyItsTaskWasNotSent) {
  environment_["XDG_RUNTIME_DIR"] = dir_.string();  // no run of this host is meant
  const std::vector<std::pair<std::vector<std::string>, int>> refused = {
      {{"task", "start", "rotate", "--direction", "lft", "--json"}, exit_status::kUsage},
      {{"task", "start", "rotat", "--json"}, exit_status::kUsage},
      {{"task", "start", "rotate", "--direction", "left", "--json"}, exit_status::kSoftware},  // no run
      {{"task", "cancel", "--json"}, exit_status::kSoftware},
      {{"task", "wait", "--event", "tea", "--json"}, exit_status::kUsage}};
  for (const auto& [arguments, status] : refused) {
    Process process = command(arguments);
    EXPECT_EQ(process.wait(30s), status) << process.errors();
    const auto json = nlohmann::json::parse(process.output(), nullptr, false);
    ASSERT_TRUE(json.is_object()) << process.output();
    const std::string reason = json.value("reason", "");
    EXPECT_FALSE(reason.empty());
    EXPECT_NE(process.errors().find(reason), std::string::npos) << process.errors();
    if (arguments[1] == "start") {
      EXPECT_TRUE(json["started"].is_null()) << json;
    }
    if (arguments[1] == "cancel") {
      EXPECT_EQ(json["cancelled"], false) << json;
    }
  }
}

// It aborted when standard error was a full disk, and reported success when standard output was one.
TEST_F(RunCommand, OutputThatCannotBeWrittenChangesTheExitStatusOnlyOfASuccess) {
  const auto status_of = [this](const std::string& command, std::string& errors) {
    Process process({"/bin/sh", "-c", program("constrictor") + " " + command}, environment_);
    const int status = process.wait(30s).value_or(-1);
    errors = process.errors();
    return status;
  };
  std::string errors;
  EXPECT_EQ(status_of("check nowhere 2> /dev/full", errors), exit_status::kConfiguration);
  EXPECT_EQ(status_of("lst 2> /dev/full", errors), exit_status::kUsage);
  EXPECT_EQ(status_of("list robots > /dev/full", errors), exit_status::kSoftware);
  EXPECT_NE(errors.find("cannot write the standard output: No space left on device"), std::string::npos) << errors;
  EXPECT_EQ(status_of("lst > /dev/full", errors), exit_status::kUsage);
  EXPECT_EQ(status_of("list robots", errors), exit_status::kOk);
}

}  // namespace
}  // namespace constrictor::testing
