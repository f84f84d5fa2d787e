// The Debian package: made, installed into an empty root, used there, and removed without a trace.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Package : public ::testing::Test {
 protected:
  Package() {
    fs::create_directories(root_ / "var/lib/dpkg/info");
    const std::ofstream status(root_ / "var/lib/dpkg/status");
    fs::create_directories(dir_.path() / "home");
  }
  /// Runs a command to its end and returns its output. It must succeed.
  std::string run(std::vector<std::string> arguments, const std::map<std::string, std::string>& environment = {}) {
    const std::string name = arguments.front();
    Process process(std::move(arguments), environment);
    EXPECT_EQ(process.wait(300s), exit_status::kOk) << name << ": " << process.output() << process.errors();
    return process.output();
  }
  /// dpkg on the empty root. It needs no rights and does not look at the packages of this machine.
  std::string dpkg(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"/usr/bin/dpkg",
                                          "--force-not-root",
                                          "--force-depends",
                                          "--log=/dev/null",
                                          "--instdir=" + root_.string(),
                                          "--admindir=" + (root_ / "var/lib/dpkg").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(std::move(arguments), {{"PATH", "/usr/sbin:/usr/bin:/sbin:/bin"}});
  }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(root_)) {
      const std::string name = entry.path().lexically_relative(root_);
      if (!name.starts_with("var")) found.insert(name);
    }
    return found;
  }
  [[nodiscard]] fs::path package(const std::string& name) const {
    for (const auto& entry : fs::directory_iterator(dir_.path() / "packages")) {
      if (entry.path().filename().string().starts_with(name + "_")) return entry.path();
    }
    return {};
  }

  TemporaryFolder dir_;
  fs::path root_ = dir_.path() / "root";
};

TEST_F(Package, IsInstalledRunAndRemoved) {
  run({"/usr/bin/cpack", "--config", testing::build_path("CPackConfig.cmake"), "-B",
       (dir_.path() / "packages").string()});
  const fs::path runtime = package("constrictor"), dev = package("constrictor-dev"),
                 python = package("python3-constrictor");
  ASSERT_FALSE(runtime.empty());
  ASSERT_FALSE(dev.empty());
  ASSERT_FALSE(python.empty());
  // Every package that it names exists, and its versions are those of this distribution.
  const std::string plan = run({"/usr/bin/apt-get", "install", "--simulate", "--no-install-recommends",
                                runtime.string(), dev.string(), python.string()});
  EXPECT_NE(plan.find("Inst constrictor "), std::string::npos) << plan;

  dpkg({"--install", runtime.string(), dev.string(), python.string()});
  const std::set<std::string> installed = files();
  for (const char* file :
       {"usr/bin/constrictor", "usr/libexec/constrictor/physics", "etc/constrictor/example.conf",
        "usr/lib/systemd/system/constrictor@.service", "usr/share/constrictor/deploy/case_study.yaml",
        "usr/share/bash-completion/completions/constrictor", "usr/share/man/man1/constrictor-topic.1.gz",
        "usr/lib/cmake/Constrictor/ConstrictorConfig.cmake", "usr/lib/python3/dist-packages/constrictor/py.typed"})
    EXPECT_TRUE(installed.contains(file)) << file;

  // A run from the package, with a manifest of this host that is found by its name.
  const std::string constrictor = root_ / "usr/bin/constrictor";
  const std::map<std::string, std::string> environment = {{"HOME", (dir_.path() / "home").string()},
                                                          {"XDG_RUNTIME_DIR", (dir_.path() / "home").string()}};
  fs::create_directories(root_ / "etc/constrictor/deploy");
  fs::copy_file(root_ / "usr/share/constrictor/deploy/case_study_fast.yaml",
                root_ / "etc/constrictor/deploy/ours.yaml");
  EXPECT_NE(run({constrictor, "list", "manifests"}).find("\nours "), std::string::npos);
  Process mission({constrictor, "run", "short", "--manifest", "ours", "--max-sim-time", "4", "--report",
                   (dir_.path() / "report").string()},
                  environment);
  EXPECT_EQ(mission.wait(60s), exit_status::kFailed) << mission.output() << mission.errors();
  const auto report = nlohmann::json::parse(std::ifstream(dir_.path() / "report/report.json"), nullptr, false);
  EXPECT_EQ(report["reason"], "time limit of 4 s (--max-sim-time)");
  EXPECT_EQ(report["processes"].size(), 2u);

  // The Python package that was installed, not that of the build tree.
  const std::string packages = root_ / "usr/lib/python3/dist-packages";
  EXPECT_EQ(run({"/usr/bin/python3", "-B", "-c", "import constrictor; print(constrictor.__file__, constrictor.runs())"},
                {{"PYTHONPATH", packages}, {"XDG_RUNTIME_DIR", (dir_.path() / "home").string()}}),
            packages + "/constrictor/__init__.py []\n");

  // The unit names a program that exists, and systemd understands it.
  const std::string unit = root_ / "usr/lib/systemd/system/constrictor@.service";
  if (fs::exists("/usr/bin/systemd-analyze")) {
    fs::create_directories(root_ / "sysinit");
    Process verify(
        {"/usr/bin/systemd-analyze", "verify", "--root=" + root_.string(), "--man=no", "constrictor@robot.service"});
    EXPECT_TRUE(verify.wait(60s).has_value());
    const std::string said = verify.output() + verify.errors();
    EXPECT_EQ(said.find("Unknown key"), std::string::npos) << said;
    EXPECT_EQ(said.find("not executable"), std::string::npos) << said;
    fs::remove_all(root_ / "sysinit");
  }

  // What a user has added stays; everything else goes, the files in /etc only with --purge.
  dpkg({"--remove", "python3-constrictor", "constrictor-dev", "constrictor"});
  EXPECT_TRUE(files().contains("etc/constrictor/example.conf"));
  dpkg({"--purge", "constrictor-dev", "constrictor"});
  std::set<std::string> left = files();
  for (const auto& folder : {"etc", "etc/constrictor", "etc/constrictor/deploy", "etc/constrictor/deploy/ours.yaml"})
    EXPECT_EQ(left.erase(folder), 1u) << folder;
  EXPECT_TRUE(left.empty()) << *left.begin();
}

}  // namespace
}  // namespace constrictor::testing
