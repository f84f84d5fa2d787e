// The service that starts at boot, with a real systemd: a small Debian is made and booted in a container, with the
// package installed, as two hosts that were switched on would be.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "runtime/host.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* kReport = "max_sim_time_s: 6\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n";
constexpr const char* kSame = " --domain 7 --manifest case_study --scenario short";

class Boot : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can boot a container";
    for (const char* program : {"/usr/sbin/debootstrap", "/usr/bin/systemd-nspawn", "/usr/bin/systemctl"}) {
      if (!fs::exists(program)) GTEST_SKIP() << program << " is missing: ./scripts/setup.sh boot";
    }
    run({"/usr/sbin/debootstrap", "--variant=minbase", "--include=systemd,systemd-sysv,dbus", "bookworm",
         root_.string()});
    run({"/usr/bin/cpack", "--config", testing::build_path("CPackConfig.cmake"), "-B", (root_ / "packages").string()});
    in_root("apt-get install --yes --no-install-recommends /packages/constrictor_*.deb && rm -r /packages");
    std::ofstream(root_ / "etc/constrictor/report.yaml") << kReport;
    configure("robot", "physics camera guidance navigation control input");
    configure("desk", "perception planner report --output runs");
    run({"/usr/bin/systemctl", "--root=" + root_.string(), "enable", "constrictor@robot", "constrictor@desk"});
  }
  void TearDown() override {
    if (container_) pull_the_plug();
  }
  /// Runs a command to its end. It must succeed.
  static void run(std::vector<std::string> arguments) {
    const std::string name = arguments.front();
    Process process(std::move(arguments), {{"DEBIAN_FRONTEND", "noninteractive"}});
    EXPECT_EQ(process.wait(600s), exit_status::kOk) << name << ": " << process.output() << process.errors();
  }
  void in_root(const std::string& command) const {
    run({"/usr/sbin/chroot", root_.string(), "/bin/sh", "-c", command});
  }
  /// Makes /etc/constrictor/NAME.conf from the example, as its first lines advise.
  void configure(const std::string& name, const std::string& parts, bool token = false) const {
    std::ifstream example(root_ / "etc/constrictor/example.conf");
    std::ofstream file(root_ / "etc/constrictor" / (name + ".conf"));
    for (std::string line; std::getline(example, line);) {
      if (line.starts_with("CONSTRICTOR_SERVE="))
        line = "CONSTRICTOR_SERVE=\"" + parts + kSame + " --config report=/etc/constrictor/report.yaml\"";
      if (token && line.starts_with("#CONSTRICTOR_TOKEN_FILE=")) line.erase(0, 1);
      file << line << '\n';
    }
  }

  void switch_on() {
    container_.emplace(std::vector<std::string>{"/usr/bin/systemd-nspawn", "--quiet", "--directory=" + root_.string(),
                                                "--register=no", "--keep-unit", "--private-network",
                                                "--resolv-conf=off", "--boot"});
  }
  /// The first process of the container; 0: none.
  [[nodiscard]] pid_t first_process() const {
    const std::string pid = std::to_string(container_->pid());
    pid_t child = 0;
    std::ifstream("/proc/" + pid + "/task/" + pid + "/children") >> child;
    return child;
  }
  /// Kills everything in the container at once.
  void pull_the_plug() {
    if (const pid_t first = first_process(); first > 0) ::kill(first, SIGKILL);
    EXPECT_TRUE(container_->wait(20s)) << container_->output();
    container_.reset();
  }
  [[nodiscard]] std::string in_container(const std::string& command) const {
    Process process(
        {"/usr/bin/nsenter", "--target", std::to_string(first_process()), "--all", "/bin/sh", "-c", command});
    process.wait(60s);
    return process.output() + process.errors();
  }
  /// The folders of missions that have ended, with the hashes of their states.
  [[nodiscard]] std::map<std::string, std::string> missions() const {
    std::map<std::string, std::string> found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(root_ / "var/lib/constrictor/desk/runs", none)) {
      const auto json = nlohmann::json::parse(std::ifstream(entry.path() / "mission.json"), nullptr, false);
      if (json.is_object() && json.contains("state_hash")) found[entry.path().filename()] = json["state_hash"];
    }
    return found;
  }
  void expect_more_missions(std::size_t more) const {
    const std::size_t before = missions().size();
    EXPECT_TRUE(eventually([&] { return missions().size() >= before + more; }, 120s, 200ms))
        << in_container("journalctl --no-pager --lines=100");
  }

  TemporaryFolder dir_;
  fs::path root_ = dir_.path() / "root";
  std::optional<Process> container_;
};

TEST_F(Boot, MissionsBeginByThemselvesAlsoAfterTheirPowerWasCut) {
  std::ofstream(dir_.path() / "report.yaml") << kReport;
  Process reference({program("constrictor"), "run", "short", "--in-process", "--config",
                     "report=" + (dir_.path() / "report.yaml").string(), "--report", (dir_.path() / "one").string()});
  ASSERT_EQ(reference.wait(120s), exit_status::kFailed) << reference.output() << reference.errors();
  const auto report = nlohmann::json::parse(std::ifstream(dir_.path() / "one/report.json"));

  switch_on();
  expect_more_missions(2);  // one run after the other
  // The host of the plant is started anew in the middle of a run: the other one follows to the next run.
  EXPECT_EQ(in_container("systemctl restart constrictor@robot"), "");
  expect_more_missions(1);
  pull_the_plug();

  // With a token, which only a user that stays can own.
  in_root(
      "useradd --system constrictor && umask 077 && echo 0123456789abcdef0123456789abcdef >/etc/constrictor/token "
      "&& chown constrictor /etc/constrictor/token");
  configure("robot", "physics camera guidance navigation control input", true);
  configure("desk", "perception planner report --output runs", true);
  switch_on();
  expect_more_missions(1);
  EXPECT_NE(in_container("constrictor pause --domain 7").find("token"), std::string::npos);
  // Both services end at once when the container is shut down.
  ::kill(first_process(), SIGRTMIN + 3);
  EXPECT_TRUE(container_->wait(30s)) << container_->output();
  container_.reset();
  for (const auto& [folder, hash] : missions()) EXPECT_EQ(hash, report["state_hash"]) << folder;
}

}  // namespace
}  // namespace constrictor::testing
