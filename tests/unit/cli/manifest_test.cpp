#include "cli/manifest.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "component/data_path.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

/// A manifest file that is removed at the end of the test.
class File {
 public:
  explicit File(const std::string& text)
      : path_(fs::temp_directory_path() / ("manifest_" + std::to_string(::getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~File() { fs::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }
  /// The error of load_manifest() without the path of the file, or "accepted".
  [[nodiscard]] std::string error() const {
    try {
      load_manifest(path_);
    } catch (const ConfigurationError& error) {
      return std::string(error.what()).substr(path_.string().size());
    }
    return "accepted";
  }

 private:
  fs::path path_;
};

const char* const kHead = "plant: physics\nrobot: r.yaml\nscenario: s.yaml\nprocesses:\n";

TEST(Manifest, NamesProgramsThatRunBesideTheRun) {
  const std::string rest = std::string(kHead) + "  - {components: [physics]}\n";
  const File file(rest + "real_time: true\nbeside:\n  - {program: robot, arguments: [--loud, '3']}\n");
  const LaunchManifest manifest = load_manifest(file.path());
  EXPECT_TRUE(manifest.real_time);
  ASSERT_EQ(manifest.beside.size(), 1u);
  EXPECT_EQ(manifest.beside[0].program, "robot");
  EXPECT_EQ(manifest.beside[0].arguments, (std::vector<std::string>{"--loud", "3"}));
  EXPECT_NE(File(rest + "beside:\n  - {arguments: [x]}\n").error().find("beside[0].program"), std::string::npos)
      << File(rest + "beside:\n  - {arguments: [x]}\n").error();
  EXPECT_NE(File(rest + "beside:\n  - {program: x, host: y}\n").error().find("unknown key"), std::string::npos);
}

TEST(Manifest, TheCaseStudyRunsEachComponentInAProcessOfItsOwn) {
  const LaunchManifest manifest = load_manifest(data_path("deploy/case_study.yaml"));
  EXPECT_EQ(manifest.plant, "physics");
  EXPECT_EQ(manifest.processes.size(), manifest.roster().size());
  EXPECT_EQ(manifest.roster().size(), 9u);
}

TEST(Manifest, TheLiveCaseStudyAddsOnlyTheOverview) {
  std::vector<std::string> roster = load_manifest(data_path("deploy/case_study_live.yaml")).roster();
  EXPECT_EQ(std::erase(roster, "overview"), 1u);
  EXPECT_EQ(roster, load_manifest(data_path("deploy/case_study.yaml")).roster());
}

TEST(Manifest, TheFastCaseStudyHasTheSameRosterInFewerProcesses) {
  const LaunchManifest fast = load_manifest(data_path("deploy/case_study_fast.yaml"));
  EXPECT_EQ(fast.roster(), load_manifest(data_path("deploy/case_study.yaml")).roster());
  EXPECT_LT(fast.processes.size(), 4u);
}

TEST(Manifest, ARosterGivesTheOrderAndNamesEachComponentOnce) {
  const std::string processes = "  - components: [physics, b]\n  - components: [a]\n";
  EXPECT_EQ(load_manifest(File(kHead + processes + "roster: [a, physics, b]\n").path()).roster(),
            (std::vector<std::string>{"a", "physics", "b"}));
  for (const char* wrong : {"[a, physics]", "[a, physics, c]", "[a, physics, b, b]"}) {
    EXPECT_NE(File(kHead + processes + "roster: " + wrong + "\n").error().find("accepted each of a, b, physics once"),
              std::string::npos)
        << wrong;
  }
}

TEST(Manifest, TheLatencyOfAProcessIsThatOfEachOfItsComponentsAlsoAfterRegrouping) {
  const File file(std::string(kHead) +
                  "  - components: [physics]\n  - components: [a, b]\n    latency_ticks: 5\n  - components: [c]\n");
  LaunchManifest manifest = load_manifest(file.path());
  regroup(manifest, {{"a", "c"}});
  EXPECT_EQ(latency_arguments(manifest), (std::vector<std::string>{"--latency", "a=5", "--latency", "b=5"}));
}

TEST(Manifest, RefusesALatencyThatCannotBe) {
  const auto error = [](const std::string& plant, const std::string& other) {
    return File(kHead + ("  - components: [physics]\n" + plant) + "  - components: [a]\n" + other).error();
  };
  EXPECT_EQ(
      error("    latency_ticks: 2\n", ""),
      ":6: processes[0].latency_ticks: found it at the process of the plant, accepted at other processes, because "
      "the plant's outputs are visible at once");
  EXPECT_EQ(error("", "    latency_ticks: 0\n"),
            ":7: processes[1].latency_ticks: found 0, accepted a whole number 1 to 100");
}

TEST(Manifest, ReadsTheSchedulingOfProcesses) {
  const File file(std::string(kHead) + "  - components: [physics]\n    scheduling: {priority: 5, lock_memory: true}\n" +
                  "  - components: [a]\n    scheduling: {priority: 3, cpus: 0-1}\n" +
                  "  - components: [b]\n    scheduling: {cpus: \"3\"}\n");
  LaunchManifest manifest = load_manifest(file.path());
  EXPECT_EQ(manifest.processes[0].scheduling.priority, 5);
  EXPECT_TRUE(manifest.processes[0].scheduling.lock_memory);
  EXPECT_EQ(manifest.processes[1].scheduling.cpus, (std::vector<int>{0, 1}));
  regroup(manifest, {{"a", "b"}});
  const Scheduling& together = manifest.processes[0].scheduling;
  EXPECT_EQ(together.priority, 3);
  EXPECT_EQ(together.cpus, (std::vector<int>{0, 1, 3}));
  regroup(manifest, {{"physics", "a", "b"}});
  EXPECT_EQ(manifest.processes[0].scheduling.priority, 5);
  EXPECT_TRUE(manifest.processes[0].scheduling.cpus.empty()) << "physics may use all processors";
}

TEST(Manifest, RefusesASchedulingThatCannotBe) {
  const auto error = [](const std::string& scheduling) {
    return File(std::string(kHead) + "  - components: [physics]\n    scheduling: {" + scheduling + "}\n").error();
  };
  EXPECT_EQ(error("priority: 100"), ":6: processes[0].scheduling.priority: found 100, accepted a whole number 0 to 99");
  EXPECT_EQ(error("cpus: 2-1"),
            ":6: processes[0].scheduling.cpus: found '2-1', accepted numbers of processors from 0 to 1023, for example "
            "0,2-3");
  EXPECT_NE(error("nice: 3").find("processes[0].scheduling.nice"), std::string::npos);
}

TEST(Manifest, ReadsProcesses) {
  const File file(std::string(kHead) +
                  "  - components: [physics]\n  - components: [a, b]\n    restarts: 3\n    environment: [X=1]\n    "
                  "config: {b: b.yaml}\n");
  const LaunchManifest manifest = load_manifest(file.path());
  EXPECT_EQ(manifest.roster(), (std::vector<std::string>{"physics", "a", "b"}));
  EXPECT_EQ(manifest.processes[0].restarts, 100) << "the plant is restarted as every other process";
  EXPECT_EQ(manifest.processes[1].restarts, 3);
  EXPECT_EQ(manifest.processes[1].name(), "a+b");
  EXPECT_EQ(manifest.processes[1].environment, std::vector<std::string>{"X=1"});
  EXPECT_EQ(manifest.config_files.at("b").filename(), "b.yaml");
}

TEST(Manifest, RefusesAVariableWithoutAValueOrAName) {
  for (const char* variable : {"X", "=1"}) {
    EXPECT_EQ(
        File(std::string(kHead) + "  - components: [physics]\n    environment: [A=1, " + variable + "]\n").error(),
        ":6: processes[0].environment: found '" + std::string(variable) + "', accepted NAME=VALUE");
  }
}

TEST(Manifest, RefusesManifestsThatDoNotDescribeARun) {
  EXPECT_EQ(File(std::string(kHead) + "  - components: [a]\n").error(),
            ":1: plant: found physics, accepted a component of processes");
  EXPECT_NE(
      File(std::string(kHead) + "  - components: [physics]\n  - components: [a, a]\n").error().find("found a twice"),
      std::string::npos);
  EXPECT_NE(File(std::string(kHead) + "  - components: []\n").error().find("accepted"), std::string::npos);
  EXPECT_NE(File(std::string(kHead) + "  - components: [physics]\n    restart: 3\n").error().find("restart"),
            std::string::npos);
  EXPECT_NE(File("plant: physics\n").error().find("robot"), std::string::npos);
}

TEST(Manifest, RegroupingMovesComponentsAndKeepsAllOfThem) {
  const File file(std::string(kHead) +
                  "  - components: [physics]\n  - components: [a, b]\n  - components: [c]\n    restarts: 2\n");
  LaunchManifest manifest = load_manifest(file.path());
  regroup(manifest, {{"c", "a"}});
  ASSERT_EQ(manifest.processes.size(), 3u);
  EXPECT_EQ(manifest.processes[0].name(), "c+a");
  EXPECT_EQ(manifest.processes[0].restarts, 2);
  EXPECT_EQ(manifest.processes[1].name(), "physics");
  EXPECT_EQ(manifest.processes[2].name(), "b");
  regroup(manifest, {{"physics", "a", "b", "c"}});
  ASSERT_EQ(manifest.processes.size(), 1u);
  EXPECT_EQ(manifest.processes[0].restarts, 2) << "the smallest number of its components' processes";
  EXPECT_THROW(regroup(manifest, {{"nobody"}}), ConfigurationError);
  EXPECT_THROW(regroup(manifest, {{"a"}, {"b", "a"}}), ConfigurationError);
}

const char* const kHosts =
    "processes:\n  - {components: [physics], host: here}\n  - {components: [control], host: robot}\n"
    "  - {components: [planner]}\n";

TEST(Manifest, ProcessesOfTheLaunchersOwnHostHaveNoHost) {
  const File file("plant: physics\nrobot: r.yaml\nscenario: s.yaml\n" + std::string(kHosts) +
                  "hosts: {here: local, robot: {ssh: snake@10.0.0.2, interface: eth0, directory: /opt/c},\n"
                  "        idle: {ssh: idle}}\n");
  const LaunchManifest manifest = load_manifest(file.path());
  EXPECT_EQ(manifest.processes[0].host, "");
  EXPECT_EQ(manifest.processes[1].host, "robot");
  EXPECT_EQ(manifest.processes[2].host, "");
  ASSERT_EQ(manifest.hosts.size(), 1u) << "a host without a process needs no connection";
  EXPECT_EQ(manifest.hosts.at("robot").ssh, "snake@10.0.0.2");
  EXPECT_EQ(manifest.hosts.at("robot").interface, "eth0");
  EXPECT_EQ(manifest.hosts.at("robot").directory, "/opt/c");
}

TEST(Manifest, RejectsHostsThatSshOrAShellCouldMisread) {
  const auto error = [](const std::string& hosts) {
    return File("plant: physics\nrobot: r.yaml\nscenario: s.yaml\n" + std::string(kHosts) + "hosts: " + hosts + "\n")
        .error();
  };
  EXPECT_EQ(error("{here: local, robot: {ssh: a}}"), "accepted");
  for (const char* ssh : {"-oProxyCommand=x", "'a b'", "'a;b'", "\"a'b\"", "''"})
    EXPECT_NE(error(std::string("{here: local, robot: {ssh: ") + ssh + "}}").find("hosts.robot.ssh: found"),
              std::string::npos)
        << ssh;
  EXPECT_EQ(error("{here: local, robot: {ssh: a, directory: ~/c}}"), "accepted");
  for (const char* directory : {"~snake/c", "/a/~", "~"})
    EXPECT_NE(
        error(std::string("{here: local, robot: {ssh: a, directory: '") + directory + "'}}").find("accepted ~ only"),
        std::string::npos)
        << directory;
  EXPECT_NE(error("{here: local, robot: {ssh: a}}\npatience_s: 2").find("patience_s: found 2, accepted at least 3"),
            std::string::npos);
  EXPECT_NE(error("{here: local, robot: {ssh: a, directory: '$(x)'}}").find("hosts.robot.directory: found '$(x)'"),
            std::string::npos);
  EXPECT_NE(error("{here: local, robot: {ssh: a, address: 10.0.0}}").find("accepted an IPv4 address"),
            std::string::npos);
  EXPECT_NE(error("{here: local, robot: {ssh: a, shh: b}}").find("did you mean"), std::string::npos);
  EXPECT_NE(error("{here: local, robot: local}").find("a second host without ssh"), std::string::npos);
  EXPECT_NE(error("{here: local, robbot: {ssh: a}}").find("found host robot, accepted here, robbot"),
            std::string::npos);
}

TEST(Manifest, AGroupHasOneHost) {
  const File file("plant: physics\nrobot: r.yaml\nscenario: s.yaml\n" + std::string(kHosts) +
                  "hosts: {here: local, robot: {ssh: a}}\n");
  LaunchManifest manifest = load_manifest(file.path());
  EXPECT_THROW(regroup(manifest, {{"physics", "control"}}), ConfigurationError);
  regroup(manifest, {{"physics", "planner"}});
  EXPECT_EQ(manifest.processes.size(), 2u);
}

}  // namespace
}  // namespace constrictor::cli
