// Processes that cannot take part in a run are refused with a reason. A run that waits names what it waits for.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "component/topic_set.hpp"
#include "integration/toy_run.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

TEST(RuntimeRefusals, ASecondMemberOfOneNameIsRefusedAndTheRunGoesOn) {
  const std::string expected = reference(2000);
  ToyRun run(2000, {"--pace", "8"});  // 5 s at least
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("navigation", 1));
  Process second({program("toy_host"), "navigation", "--domain", std::to_string(run.claim.domain()), "--roster",
                  kRoster, "--scenario", "2000", "--robot", ""});
  EXPECT_EQ(second.wait(20s), exit_status::kRefused);
  EXPECT_NE(second.errors().find("two members of one name"), std::string::npos) << second.errors();
  EXPECT_EQ(run.result(), expected);
}

TEST(RuntimeRefusals, AWrongCommandLineIsExplained) {
  const auto refusal = [](std::vector<std::string> words) {
    words.insert(words.begin(), {program("toy_host"), "navigation"});
    Process process(std::move(words));
    EXPECT_EQ(process.wait(20s), exit_status::kUsage) << process.errors();
    return process.errors();
  };
  const std::string help = " (see navigation --help)\n";
  EXPECT_EQ(refusal({"--domian", "3"}), "navigation: no option '--domian', did you mean '--domain'?" + help);
  EXPECT_EQ(refusal({"--domain", "230"}),
            "navigation: --domain: found '230', accepted a whole number from 0 to 229" + help);
  EXPECT_EQ(refusal({"--images", "ofF"}),
            "navigation: --images: found 'ofF', accepted on, off, recompute, did you mean 'off'?" + help);
  EXPECT_EQ(refusal({"--patience", "-1"}),
            "navigation: --patience: found '-1', accepted a number from 0 to 86400 s" + help);
}

TEST(RuntimeRefusals, AMissingMemberIsNamedAndTheOthersGiveUp) {
  ToyRun run(100, {"--patience", "4"});
  run.start_all({"physics", "navigation", "control", "report"});
  for (auto& [group, process] : run.processes) EXPECT_EQ(process.wait(20s), exit_status::kWaitedTooLong) << group;
  EXPECT_NE(run.processes.at("physics").errors().find("waits for Hello of planner"), std::string::npos)
      << run.processes.at("physics").errors();
}

// A process that stands in for a member may have a writer whose QoS does not match: the log names both.
TEST(RuntimeRefusals, AnEndpointThatDoesNotMatchIsNamedWithItsQos) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const auto hellos = dds::Reader<msg::Hello>::member(domain.participant(), barrier_topics::kHello);
  const dds::Writer<msg::Hello> hello(domain.participant(), barrier_topics::kHello, 1);
  Process physics({program("toy_host"), "physics", "--domain", std::to_string(claim.domain()), "--roster",
                   "physics,control", "--robot", ""});
  msg::Hello control{};
  ASSERT_TRUE(eventually([&] {
    hellos.take([&](const msg::Hello& message) { control = message; });
    return control.incarnation == 1;
  })) << physics.errors();
  dds::set_text(control.component, "control");
  control.pid = ::getpid();
  control.reads = 0;
  control.writes = TopicSet::of(topics::kJointCommand).bits();
  hello.write(control);
  const std::string here =
      "joint_command: the reader here (reliable, transient-local, keep-all) has not met the writer of control";
  EXPECT_TRUE(physics.wait_for(here + ", which is not there", 20s)) << physics.errors();

  const dds::Entity topic(
      dds_create_topic(domain.participant(), &dds::descriptor<msg::JointCommand>(), "joint_command", nullptr, nullptr),
      "dds_create_topic");
  const dds::Qos qos = dds::make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 3);
  const auto write_as = [&](const std::string& name) {
    dds_qset_userdata(qos.get(), name.data(), name.size());
    return dds::Entity(dds_create_writer(domain.participant(), topic.get(), qos.get(), nullptr), "dds_create_writer");
  };
  {
    const dds::Entity named = write_as("control");
    EXPECT_TRUE(physics.wait_for(
        here + " (best effort, transient-local, keep-last 3); reliability: the writer offers best effort, the reader "
               "requests reliable",
        20s))
        << physics.errors();
  }
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  {
    const dds::Entity nameless = write_as("");
    EXPECT_TRUE(physics.wait_for(
        "there is a writer without a name (reliable, transient-local, keep-last 3); its user data must be 'control'",
        20s))
        << physics.errors();
  }
  const dds::Entity matching = write_as("control");
  EXPECT_TRUE(physics.wait_for("waits for Ready of control", 20s)) << "all endpoints match: " << physics.errors();
}

TEST(RuntimeRefusals, AnotherNumericProfileIsRefused) {
  ToyRun run(100, {"--patience", "6"});
  run.start_all({"physics", "navigation", "control", "report"});
  run.start("planner", 1, {{"GLIBC_TUNABLES", "glibc.malloc.perturb=0"}});
  EXPECT_EQ(run.processes.at("planner").wait(20s), exit_status::kRefused);
  EXPECT_NE(run.processes.at("planner").errors().find("numeric profile differs"), std::string::npos);
}

TEST(RuntimeRefusals, AnotherScenarioIsRefused) {
  const TemporaryFolder folder;
  const std::string other = folder.path() / "100";  // the same name, but another content
  std::ofstream(other) << "mission: {}\n";
  ToyRun run(100, {"--patience", "6"});
  run.start_all({"physics", "navigation", "control", "report"});
  Process planner({program("toy_host"), "planner", "--domain", std::to_string(run.claim.domain()), "--roster", kRoster,
                   "--scenario", other, "--robot", ""});
  EXPECT_EQ(planner.wait(20s), exit_status::kRefused);
  EXPECT_NE(planner.errors().find("scenario differs"), std::string::npos) << planner.errors();
}

// A restarted member reads its configuration file again. If the file has changed, the member is refused; otherwise the
// change would silently alter the result of the run.
TEST(RuntimeRefusals, ARestartedMemberWithAnotherConfigurationIsRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path config = folder.path() / "planner.yaml";
  std::ofstream(config) << "first: 1\n";
  ToyRun run(100'000, {"--config", "planner=" + config.string(), "--patience", "20"});
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("planner", 1));
  run.processes.at("planner").signal(SIGKILL);
  run.processes.at("planner").wait(10s);
  run.start("planner", 2);
  ASSERT_TRUE(run.wait_for_step_of("planner", 2)) << "an unchanged file must be accepted";
  std::ofstream(config) << "first: 2\n";
  run.processes.at("planner").signal(SIGKILL);
  run.processes.at("planner").wait(10s);
  run.start("planner", 3);
  EXPECT_EQ(run.processes.at("planner").wait(20s), exit_status::kRefused);
  EXPECT_NE(run.processes.at("planner").errors().find(
                "its configuration or scenario file differs from the one that the run began with"),
            std::string::npos)
      << run.processes.at("planner").errors();
}

}  // namespace
}  // namespace constrictor::testing
