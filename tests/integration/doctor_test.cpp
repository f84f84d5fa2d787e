// `constrictor doctor` with real processes: a run of toy components, and programs of other projects.
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/introspection_fixture.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

// A conductor refuses a second member of the same name at once. Here no conductor runs yet, so both members wait for
// it.
TEST_F(Introspection, TheDoctorFindsASecondMember) {
  const DomainClaim claim;
  const std::vector<std::string> arguments = {program("toy_host"), "navigation",
                                              "--domain",          std::to_string(claim.domain()),
                                              "--roster",          "physics,navigation,control"};
  const Process first(arguments, environment_);
  const Process second(arguments, environment_);
  EXPECT_TRUE(eventually([&] {
    command({"doctor", "--run", std::to_string(claim.domain()), "--json"});
    return output_.find("two members of one name") != std::string::npos;
  })) << output_;
  EXPECT_NE(output_.find(std::to_string(first.pid())), std::string::npos) << output_;
  EXPECT_NE(output_.find(std::to_string(second.pid())), std::string::npos) << output_;
}

// The project's own plants refuse to run beside each other, but a driver from elsewhere may not check this.
TEST_F(Introspection, TheDoctorFindsASecondPlant) {
  Process run = toys();
  const Process second = foreign(domain(), "plant");
  std::vector<std::string> found;
  EXPECT_TRUE(eventually([&] {
    found = faults(domain());
    return std::count(found.begin(), found.end(), "two plants") == 1;
  })) << output_;
  EXPECT_NE(output_.find(std::to_string(second.pid())), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, TheDoctorFindsThatTheRunIsInAnotherDomain) {
  Process run = toys();
  const DomainClaim empty;
  EXPECT_EQ(faults(empty.domain()), std::vector<std::string>{"wrong domain"}) << output_;
  EXPECT_NE(output_.find("--run " + std::to_string(domain())), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, TheDoctorFindsWrongInterfacesAndSmallSocketBuffers) {
  const DomainClaim claim;
  const auto with = [this](const std::string& general) {
    environment_["CYCLONEDDS_URI"] = "<CycloneDDS><Domain><General>" + general + "</General></Domain></CycloneDDS>";
  };
  with("<Interfaces><NetworkInterface name=\"nosuch0\"/></Interfaces>");
  auto found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "wrong interface"), 1) << output_;
  EXPECT_NE(output_.find("name one of"), std::string::npos) << output_;
  with("<Interfaces><NetworkInterface name=\"lo\"/></Interfaces><AllowMulticast>false</AllowMulticast>");
  found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "missing multicast"), 1) << output_;
  // The expectation depends on this host's limit, because a test must not change the limit.
  std::uint64_t limit_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit_bytes;
  EXPECT_EQ(std::count(found.begin(), found.end(), "small socket buffers"), limit_bytes < 1024 * 1024 ? 1 : 0)
      << limit_bytes << output_;
}

TEST_F(Introspection, TheDoctorFindsAConfigurationThatCannotBeReadOrIsWrong) {
  using Faults = std::vector<std::string>;
  const DomainClaim claim;
  environment_["CYCLONEDDS_URI"] = "file:///nosuch/cyclonedds.xml";
  EXPECT_EQ(faults(claim.domain()), (Faults{"unreadable configuration", "no DDS"})) << output_;
  EXPECT_NE(output_.find("cannot read /nosuch/cyclonedds.xml"), std::string::npos) << output_;
  EXPECT_EQ(output_.find("can't open"), std::string::npos) << "the finding is enough: " << output_;
  EXPECT_NE(output_.find("cure the findings above first"), std::string::npos) << output_;
  write("unclosed.xml", "<CycloneDDS><Domain>\n");
  for (const std::string wrong :
       {"<CycloneDDS><Domain></CycloneDDS>", "<CycloneDDS><Domain><Nonsense>3</Nonsense></Domain></CycloneDDS>",
        "file://UNCLOSED"}) {
    environment_["CYCLONEDDS_URI"] = wrong == "file://UNCLOSED" ? "file://" + (dir_ / "unclosed.xml").string() : wrong;
    EXPECT_EQ(faults(claim.domain()), Faults{"no DDS"}) << wrong << output_;
    EXPECT_NE(output_.find("unset CYCLONEDDS_URI, or correct it"), std::string::npos) << output_;
  }
}

TEST_F(Introspection, TheDoctorFindsAnEmptyDomainAndATopicWithTwoTypes) {
  const DomainClaim claim;
  EXPECT_EQ(faults(claim.domain()), std::vector<std::string>{"empty domain"}) << output_;
  const Process talker = foreign(claim.domain(), "final");
  const dds::Domain domain(claim.domain());
  const auto other = dds::Reader<msg::RunState>::observer(domain.participant(), "weather");
  EXPECT_EQ(faults(claim.domain()), std::vector<std::string>{"differing type"}) << output_;
  EXPECT_NE(output_.find("foreign::Weather"), std::string::npos) << output_;
  EXPECT_NE(output_.find("constrictor::msg::RunState"), std::string::npos) << output_;
}

TEST_F(Introspection, TheDoctorFindsIncompatibleQosAndAMemberOfAnotherVersion) {
  const DomainClaim claim;
  const Process deaf = foreign(claim.domain(), "silent_qos");
  const Process other = foreign(claim.domain(), "other_idl");
  const auto found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "differing QoS"), 1) << output_;
  EXPECT_EQ(std::count(found.begin(), found.end(), "differing IDL hash"), 1) << output_;
}

}  // namespace
}  // namespace constrictor::testing
