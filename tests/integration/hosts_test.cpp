// Runs on several hosts with the real launcher and agents. A script in place of ssh runs the command on this host, with
// a run directory of its own; tests/integration/hosts_long_test.cpp has real hosts, networks and sshd.
#include <regex>

#include "integration/hosts_fixture.hpp"

namespace constrictor::testing {
namespace {

TEST_F(Hosts, ARunOnTwoHostsHasTheResultOfOneProcessAndLeavesNothing) {
  ASSERT_EQ(run_there(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run_there(300, "two");
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  Process diff = command({"diff", (dir_ / "one").string(), (dir_ / "two").string()});
  EXPECT_EQ(diff.wait(10s), 0) << diff.output();
  const auto json = report("two");
  EXPECT_EQ(json["processes"][0]["host"], "here");
  EXPECT_EQ(json["processes"][2]["host"], "robot");
  // The first line of a process names the program that started it, here the agent of its host.
  EXPECT_TRUE(std::regex_search(log("two", "control"), std::regex("started by constrictor \\S+ git \\w+")))
      << log("two", "control");
  EXPECT_GT(json["processes"][2]["cpu_s"], 0.0);
  EXPECT_EQ(json["hosts"]["robot"]["release"], json["hosts"]["here"]["release"]);
  EXPECT_TRUE(json["hosts"]["robot"]["libraries"].contains("ode"));
  EXPECT_NE(log("two", "report").find("result "), std::string::npos) << "the log was not forwarded";
  expect_nothing_left();
}

TEST_F(Hosts, AProcessThatDiesThereIsRestartedAndItsLastLinesAreShown) {
  ASSERT_EQ(run_there(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  write("dies_once", "#!/bin/sh\ncase \"$*\" in *\"--incarnation 1\"*) echo out of luck; exit 3;; esac\nexec " +
                         program("toy_host") + " \"$@\"\n");
  fs::permissions(dir_ / "dies_once", fs::perms::owner_all);
  std::ifstream file(dir_ / "hosts.yaml");
  const std::string manifest(std::istreambuf_iterator<char>(file), {});
  write("hosts.yaml",
        replaced(manifest, "[control], program: toy_host", "[control], program: " + (dir_ / "dies_once").string()));
  Process launcher = run_there(300, "two");
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_NE(launcher.output().find("control: out of luck"), std::string::npos) << launcher.output();
  EXPECT_NE(launcher.output().find("control ended with status 3; restarted as incarnation 2"), std::string::npos)
      << launcher.output();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  expect_nothing_left();
}

TEST_F(Hosts, ABrokenConnectionIsMadeAgainAndDisturbsNoProcess) {
  ASSERT_EQ(run_there(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run_there(300, "two", {"--pace", "2x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; })) << launcher.output() << launcher.errors();
  const auto before = members();
  // The processes of the connection: those with the token that do not lead a session, as the agent does.
  const pid_t keeper = agent();
  ASSERT_GT(keeper, 0);
  int killed = 0;
  for (const auto& [pid, line] : command_lines()) {
    if (line.find("--token") == std::string::npos || line.find("agent") == std::string::npos || pid == keeper) continue;
    if (std::stol("0" + line_of_status(pid, "PPid:").substr(1)) != launcher.pid()) continue;
    ::kill(pid, SIGKILL);
    ++killed;
  }
  ASSERT_GT(killed, 0);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  for (const auto& process : report("two")["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
  expect_nothing_left();
}

TEST_F(Hosts, WhenTheAgentIsKilledItsProcessesAreStartedAgain) {
  ASSERT_EQ(run_there(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run_there(300, "two", {"--pace", "2x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; })) << launcher.output() << launcher.errors();
  ::kill(agent(), SIGKILL);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  EXPECT_EQ(report("two")["processes"][2]["restarts"], 1) << launcher.output();
  expect_nobody_left();
}

TEST_F(Hosts, WhenTheLauncherIsKilledNothingIsLeftButWhatTheRunNeedsToGoOn) {
  patience(6);
  Process launcher = run_there(100000, "two", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; })) << launcher.output() << launcher.errors();
  launcher.signal(SIGKILL);
  expect_nothing_runs();  // within the manifest's patience
  EXPECT_FALSE(fs::is_empty(state() / "constrictor"));
}

TEST_F(Hosts, AHostThatCannotBeReachedIsTriedForThePatience) {
  patience(4);
  ssh("echo x >> " + (dir_ / "tries").string() + "; echo 'ssh: connect to host: No route to host' >&2; exit 255");
  const auto start = std::chrono::steady_clock::now();
  Process launcher = run_there(300, "two");
  ASSERT_EQ(launcher.wait(60s), exit_status::kSoftware) << launcher.output();
  EXPECT_GE(std::chrono::steady_clock::now() - start, 4s) << "the patience of the manifest";
  EXPECT_NE(launcher.errors().find("host robot (snake@10.0.0.2): could not be reached for 4 s"), std::string::npos)
      << launcher.errors();
  EXPECT_NE(launcher.errors().find("No route to host"), std::string::npos) << launcher.errors();
  EXPECT_GE(fs::file_size(dir_ / "tries"), 2u * 3u) << "at least three attempts";
  EXPECT_LE(fs::file_size(dir_ / "tries"), 2u * 8u) << "the pause between attempts grows";
  EXPECT_FALSE(fs::exists(dir_ / "two")) << "no report of a run that has not begun";
}

TEST_F(Hosts, ADirectoryInTheHomeOfTheOtherHostIsFound) {
  fs::create_directory(dir_ / "home");
  fs::create_directory_symlink(bin_, dir_ / "home/snake");
  environment_["HOME"] = (dir_ / "home").string();
  hosts("directory: ~/snake", 20);
  Process launcher = run_there(50, "two");
  EXPECT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
}

TEST_F(Hosts, AHostWithAnotherReleaseIsRefused) {
  fs::create_directories(dir_ / "other/bin");
  write("other/bin/constrictor", "#!/bin/sh\necho 9.9.9\n");
  fs::permissions(dir_ / "other/bin/constrictor", fs::perms::owner_all);
  hosts("directory: " + (dir_ / "other").string(), 20);
  Process launcher = run_there(300, "two");
  ASSERT_EQ(launcher.wait(30s), exit_status::kSoftware) << launcher.output();
  EXPECT_NE(launcher.errors().find("other/bin/constrictor is 9.9.9"), std::string::npos) << launcher.errors();
  EXPECT_TRUE(members().empty());
}

TEST_F(Hosts, TheDoctorReportsHostsThatAreReadyAndHostsThatAreNot) {
  Process well = command({"doctor", "--manifest", (dir_ / "hosts.yaml").string()});
  EXPECT_EQ(well.wait(30s), exit_status::kOk) << well.output() << well.errors();
  EXPECT_NE(well.output().find("no fault found"), std::string::npos) << well.output();
  expect_nothing_left();
  ssh("echo 'snake@10.0.0.2: Permission denied (publickey).' >&2; exit 255");
  Process refused = command({"doctor", "--manifest", (dir_ / "hosts.yaml").string()});
  EXPECT_EQ(refused.wait(30s), exit_status::kFailed) << "it must not try for the patience";
  EXPECT_NE(refused.output().find("Permission denied (publickey)"), std::string::npos) << refused.output();
}

TEST_F(Hosts, AHostThatComputesOtherwiseIsRefusedWithTheDifferences) {
  // A copy of this release with another version of ODE, on a processor with another libm.
  const fs::path other = dir_ / "other";
  fs::create_directory(other);
  fs::copy_file(program("constrictor"), other / "constrictor");
  write("other/constrictor_host",
        "#!/bin/sh\n" + program("constrictor_host") +
            " \"$@\" | sed 's/libode.so[^ ]*/libode.so.9/; s/^profile libm ./profile libm x/'\n");
  fs::permissions(other / "constrictor_host", fs::perms::owner_all);
  hosts("directory: " + other.string(), 20);
  Process launcher = run_there(300, "two");
  ASSERT_EQ(launcher.wait(30s), exit_status::kSoftware) << launcher.output();
  EXPECT_NE(launcher.errors().find("host robot: numeric profile: found libm x"), std::string::npos)
      << launcher.errors();
  EXPECT_NE(launcher.errors().find("host robot: library ode: found libode.so.9"), std::string::npos)
      << launcher.errors();
  EXPECT_TRUE(members().empty());
  expect_nothing_left();
}

}  // namespace
}  // namespace constrictor::testing
