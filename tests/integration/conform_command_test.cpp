// `constrictor conform` refuses what is not one part, before it moves or asks anything; and serves parts that a user
// starts by hand.
#include <csignal>

#include "cyclone/domain_claim.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class ConformCommand : public CliFixture {};

TEST_F(ConformCommand, ChoosesNoPlantByItself) {
  environment_["CONSTRICTOR_DOMAIN"] = "";
  EXPECT_EQ(command({"conform", "plant", "--yes"}), exit_status::kUsage) << output_;
  EXPECT_NE(output_.find("found no --domain and no --manifest"), std::string::npos) << output_;
  EXPECT_EQ(command({"conform", "control"}), exit_status::kUsage) << output_;
  EXPECT_NE(output_.find("found no --domain and no --manifest"), std::string::npos) << output_;
  environment_["CONSTRICTOR_DOMAIN"] = "many";
  EXPECT_EQ(command({"conform", "plant", "--yes"}), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("CONSTRICTOR_DOMAIN"), std::string::npos) << output_;
}

TEST_F(ConformCommand, TakesADomainOrAManifestAndNotBoth) {
  environment_["CONSTRICTOR_DOMAIN"] = "5";  // the environment is no option: it excludes nothing
  for (const char* part : {"plant", "camera"}) {
    EXPECT_EQ(command({"conform", part, "--yes", "--domain", "5", "--manifest", "emulated_servos"}),
              exit_status::kUsage)
        << output_;
    EXPECT_NE(output_.find("excludes"), std::string::npos) << output_;
  }
  EXPECT_EQ(command({"conform", "plant", "--yes", "--manifest", "no_such.yaml"}), exit_status::kConfiguration)
      << output_;
}

TEST_F(ConformCommand, RefusesAMissingManifestBeforeItAsks) {
  for (const char* part : {"plant", "camera"}) {
    EXPECT_EQ(command({"conform", part, "--manifest", "no_such.yaml"}), exit_status::kConfiguration) << output_;
    EXPECT_NE(output_.find("no_such.yaml"), std::string::npos) << output_;
    EXPECT_EQ(output_.find("Type yes"), std::string::npos) << output_;
    EXPECT_EQ(command({"conform", part, "--manifest", "case_stdy"}), exit_status::kConfiguration) << output_;
    EXPECT_NE(output_.find("manifest: found 'case_stdy', accepted a file or one of case_study"), std::string::npos)
        << output_;
    EXPECT_NE(output_.find(", did you mean 'case_study'?"), std::string::npos) << output_;
  }
}

TEST_F(ConformCommand, AnInterruptEndsTheRunAndNamesWhatWasNotChecked) {
  Process process = start({"conform", "control", "--manifest", "case_study"});
  ASSERT_TRUE(process.wait_for("echo", 60s)) << process.output() << process.errors();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60s), 128 + SIGINT) << process.output() << process.errors();
  EXPECT_NE(process.output().find("not checked: "), std::string::npos) << process.output() << process.errors();
}

/// Starts the part as a user does: with the printed line of arguments, in a shell.
class PartStartedByHand : public ConformCommand, public ::testing::WithParamInterface<const char*> {};

TEST_P(PartStartedByHand, IsServedInItsDomain) {
  const std::string part = GetParam();
  const DomainClaim claim;
  Process conform =
      start({"conform", part, "--domain", std::to_string(claim.domain()), "--json", (dir_ / "result.json").string()});
  ASSERT_TRUE(conform.wait_for("--scenario", 20s)) << conform.errors();
  const std::string output = conform.output();
  const auto begin = output.find("  --domain");
  ASSERT_NE(begin, std::string::npos) << output;
  Process hand({"/bin/sh", "-c", "exec " + program(part) + output.substr(begin, output.find('\n', begin) - begin)},
               environment_);
  EXPECT_EQ(conform.wait(100s), exit_status::kOk) << conform.output() << conform.errors() << hand.errors();
  EXPECT_EQ(hand.wait(20s), exit_status::kOk) << "the part notices the end of the run: " << hand.errors();
  const auto result = nlohmann::json::parse(std::ifstream(dir_ / "result.json"), nullptr, false);
  ASSERT_TRUE(result.is_object()) << conform.output();
  EXPECT_TRUE(result["conforms"].get<bool>());
  EXPECT_NE(conform.output().find("skipped      restart"), std::string::npos) << conform.output();
}

INSTANTIATE_TEST_SUITE_P(Parts, PartStartedByHand, ::testing::Values("perception", "planner"),
                         [](const auto& one) { return std::string(one.param); });

TEST_F(ConformCommand, ServesNoPartInTheDomainOfARun) {
  Process run = start({"run", "--manifest", "case_study", "--pace", "1x", "--report", (dir_ / "run").string()});
  ASSERT_TRUE(eventually([&] { return domain() != 0; }, 60s)) << run.output();
  EXPECT_EQ(command({"conform", "control", "--domain", std::to_string(domain())}), exit_status::kUsage) << output_;
  EXPECT_NE(output_.find("found a run in domain"), std::string::npos) << output_;
  run.signal(SIGINT);
  EXPECT_TRUE(run.wait(60s).has_value());
}

TEST_F(ConformCommand, NamesThePartThatNobodyHasStarted) {
  const DomainClaim claim;
  EXPECT_EQ(command({"conform", "control", "--domain", std::to_string(claim.domain()), "--patience", "2"}),
            exit_status::kFailed)
      << output_;
  EXPECT_NE(output_.find("Hello of control"), std::string::npos) << output_;
  EXPECT_EQ(command({"conform", "control", "--domain", "5", "--scenario", "no_such.yaml"}), exit_status::kConfiguration)
      << output_;
}

}  // namespace
}  // namespace constrictor::testing
