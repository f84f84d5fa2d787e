// `constrictor conform` refuses what is not one part, before it moves or asks anything.
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
  EXPECT_NE(output_.find("found no --manifest"), std::string::npos) << output_;
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
  }
}

}  // namespace
}  // namespace constrictor::testing
