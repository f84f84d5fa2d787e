// What disturbs the connection between the launcher and the agent of another host, and what does not fit on a disk.
#include "integration/hosts_fixture.hpp"
#include "integration/run_ticks.hpp"

namespace constrictor::testing {
namespace {

class HostsFaults : public Hosts {
 protected:
  static constexpr long kTicks = 300;

  /// Starts a run and waits until all its processes take part.
  [[nodiscard]] Process begun(const std::string& pace) const {
    Process launcher = run_there(kTicks, "two", {"--pace", pace});
    EXPECT_TRUE(eventually([&] { return members().size() == 5; })) << launcher.output() << launcher.errors();
    EXPECT_TRUE(RunTicks(launcher).pass(20)) << launcher.output() << launcher.errors();
    return launcher;
  }
};

// As virtual machines that are stopped, or computers that sleep. The leases of the participants lapse meanwhile: they
// last 2 s here instead of 10 s, so that the patience, which must be longer than DDS needs to find participants again,
// can be short.
TEST_F(HostsFaults, AFreezeOfAllHostsLongerThanThePatienceEndsNoRun) {
  constexpr int kPatience_s = 5;
  patience(kPatience_s);
  ASSERT_EQ(run_there(kTicks, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  environment_["CYCLONEDDS_URI"] =
      dds::loopback_configuration() +
      ",<CycloneDDS><Domain><Discovery><LeaseDuration>2s</LeaseDuration></Discovery></Domain></CycloneDDS>";
  Process launcher = begun("1x");
  RunTicks observer(launcher);
  const auto ticks = dds::Reader<msg::Tick>::observer(observer.participant(), barrier_topics::kTick);
  ASSERT_TRUE(eventually([&] { return ticks.writers() > 0; }));
  const auto begin = std::chrono::steady_clock::now();
  signal_all(SIGSTOP);
  EXPECT_TRUE(eventually([&] {
    const auto frozen = std::chrono::steady_clock::now() - begin;
    return ticks.writers() == 0 && frozen > std::chrono::seconds(kPatience_s) + 500ms;
  })) << "the lease of the plant's process has not lapsed";
  signal_all(SIGCONT);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  for (const auto& process : report("two")["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
  expect_nothing_left();
}

TEST_F(HostsFaults, AFileThatCannotBeWrittenHereIsNamedAndStaysOnItsHost) {
  Process launcher = begun("1x");
  fs::create_symlink("/dev/full", dir_ / "two/mission.json");  // a disk on which there is no space
  ASSERT_TRUE(launcher.wait(60s));
  EXPECT_NE(launcher.output().find("1 of the files that its processes wrote is not in the report: cannot write " +
                                   (dir_ / "two/mission.json").string() + ": No space left on device"),
            std::string::npos)
      << launcher.output();
  EXPECT_FALSE(fs::exists(dir_ / "two/mission.json")) << "a part of a file";
  expect_nothing_runs();
  ASSERT_FALSE(fs::is_empty(state() / "constrictor"));
  const fs::path kept = fs::directory_iterator(state() / "constrictor")->path();
  EXPECT_NE(launcher.output().find("keeps them for a week in " + kept.string()), std::string::npos);
  EXPECT_TRUE(fs::exists(kept / "mission.json"));
}

TEST_F(HostsFaults, AFetchThatTakesLongIsSaidAndEndsAtCtrlC) {
  Process launcher = begun("1x");
  // A sparse file, as large as a recording of hours, beside what the report has written.
  const fs::path kept = fs::directory_iterator(state() / "constrictor")->path();
  std::ofstream(kept / "large.bin").close();
  fs::resize_file(kept / "large.bin", std::uintmax_t{500} << 30);
  ASSERT_TRUE(launcher.wait_for("fetching the files that processes on other hosts wrote; Ctrl-C", 60s))
      << launcher.output();
  launcher.signal(SIGINT);
  ASSERT_TRUE(launcher.wait(20s)) << launcher.output();
  EXPECT_NE(launcher.output().find("interrupted; the files that have not arrived stay where they are"),
            std::string::npos)
      << launcher.output();
  EXPECT_NE(launcher.output().find("keeps them for a week in " + kept.string()), std::string::npos);
  EXPECT_TRUE(fs::exists(kept / "large.bin"));
  expect_nothing_runs();
}

TEST_F(HostsFaults, AnUndisturbedRunMakesOneConnection) {
  const std::string count = (dir_ / "count").string();
  ssh("echo x >> " + count);
  for (std::uintmax_t runs = 1; runs <= 3; ++runs) {
    Process launcher = run_there(100, "two");
    ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
    ASSERT_EQ(fs::file_size(count), 2 * runs);
    fs::remove_all(dir_ / "two");
  }
}

// A host that boots may be reachable before its name is, and the launcher's network may be gone for a moment.
TEST_F(HostsFaults, ANameThatIsUnknownForAMomentEndsNoRun) {
  const std::string count = (dir_ / "count").string();
  ASSERT_EQ(run_there(kTicks, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  // The connections: the first one, one that finds that the agent has died, and those that shall start it again.
  ssh("echo x >> " + count + "; case $(grep -c x " + count +
      ") in 3|4) echo 'ssh: Could not resolve hostname robot.local: Name or service not known' >&2; exit 255;; esac");
  Process launcher = begun("1x");
  const pid_t keeper = agent();
  ASSERT_GT(keeper, 0);
  ::kill(keeper, SIGKILL);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_GE(fs::file_size(count), 2u * 5u);
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  expect_nobody_left();
}

TEST_F(HostsFaults, ANameServerThatDoesNotAnswerIsAskedAgain) {
  const std::string count = (dir_ / "count").string();
  ssh("echo x >> " + count + "; case $(grep -c x " + count +
      ") in 1|2) echo 'ssh: Could not resolve hostname robot: Temporary failure in name resolution' >&2; exit 255;; "
      "esac");
  Process launcher = run_there(100, "two");
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  expect_nothing_left();
}

}  // namespace
}  // namespace constrictor::testing
