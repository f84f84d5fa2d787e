// Runs with DDS Security: only participants with an identity of the run's authority take part, each with the rights of
// its components.
#include <cstdlib>

#include "cli/keys/authority.hpp"
#include "cli/keys/rights.hpp"
#include "cyclone/domain.hpp"
#include "integration/attacker.hpp"
#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

/// Sets a variable of this process, in which the test itself joins the run, and removes it again.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

class Secure : public RunCommand {
 protected:
  static constexpr long kTicks = 600;

  void SetUp() override {
    environment_["XDG_RUNTIME_DIR"] = dir_.string();
    make_keys("keys");
  }
  void make_keys(const std::string& folder) const {
    Process keys = command({"keys", (dir_ / folder).string(), "--manifest", (dir_ / "toys.yaml").string()});
    ASSERT_EQ(keys.wait(30s), exit_status::kOk) << keys.output() << keys.errors();
  }
  [[nodiscard]] std::string keys() const { return (dir_ / "keys").string(); }
  /// Starts a secured run and waits until it makes ticks.
  [[nodiscard]] Process secured_run(long ticks, const std::string& pace) const {
    Process launcher = run(ticks, "secured", {"--secure", keys(), "--pace", pace});
    EXPECT_TRUE(launcher.wait_for("simulated", 40s)) << launcher.output() << launcher.errors();
    return launcher;
  }
};

TEST_F(Secure, ASecuredRunHasTheResultOfAnUnsecuredOneAndCommandsFindTheirIdentity) {
  Process reference = run(kTicks, "reference", {"--in-process"});
  ASSERT_EQ(reference.wait(60s), exit_status::kOk) << reference.errors();
  Process launcher = secured_run(kTicks, "1x");
  for (const std::string name : {"pause", "status", "resume"}) {
    Process process = command({name});
    EXPECT_EQ(process.wait(20s), exit_status::kOk) << name << process.output() << process.errors();
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("secured"), state_hash("reference"));
  EXPECT_NE(state_hash("reference"), "none");
  for (const auto& entry : fs::recursive_directory_iterator(dir_ / "keys")) {
    if (entry.path().filename().string().find("key.pem") != std::string::npos) {
      EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write) << entry.path();
    }
  }
}

TEST_F(Secure, AStrangerWithoutAnIdentityOrWithOneOfAnotherAuthorityMeetsNobody) {
  Process launcher = secured_run(100'000, "1x");
  const unsigned domain = domain_of(launcher);
  {
    Attacker plain(domain);
    EXPECT_FALSE(plain.meets_anybody(2s));
  }
  make_keys("foreign");
  {
    const Variable folder("CONSTRICTOR_SECURITY", (dir_ / "foreign").string());
    const dds::Domain rogue(domain);
    const auto states = dds::Reader<msg::RunState>::member(rogue.participant(), wire::kRunState);
    const dds::Writer<msg::EmergencyStop> stop(rogue.participant(), wire::kEmergencyStop);
    EXPECT_FALSE(eventually([&] { return states.writers() > 0 || stop.readers() > 0; }, 2s));
  }
  {
    const Variable folder("CONSTRICTOR_SECURITY", keys());
    const dds::Domain invited(domain, dds::Reach::kLoopback, "observer");
    const auto states = dds::Reader<msg::RunState>::member(invited.participant(), wire::kRunState);
    std::optional<msg::RunState> state;
    EXPECT_TRUE(eventually([&] {
      states.take([&](const msg::RunState& message) { state = message; });
      return state.has_value();
    })) << "the same program with an identity reads the run";
  }
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(20s));
}

// An attacker has copied the files of one component, and tries to do what only another component may do.
TEST_F(Secure, AStolenIdentityGivesNoRightsButThoseOfItsComponent) {
  Process launcher = secured_run(100'000, "1x");
  const Variable folder("CONSTRICTOR_SECURITY", keys());
  {
    const dds::Domain thief(domain_of(launcher), dds::Reach::kLoopback, "report");
    const dds_entity_t own = thief.participant();
    EXPECT_NO_THROW(dds::Writer<msg::Hello>(own, wire::kHello)) << "every member may send Hello";
    EXPECT_THROW(dds::Writer<msg::JointCommand>(own, std::string(topics::kJointCommand.name), 8), dds::Error);
    EXPECT_THROW(dds::Writer<msg::Tick>(own, wire::kTick), dds::Error);
    EXPECT_THROW(dds::Writer<msg::RunControl>(own, wire::kRunControl), dds::Error);
    EXPECT_THROW(dds::Writer<msg::EmergencyStop>(own, wire::kEmergencyStop), dds::Error);
    EXPECT_THROW(dds::Reader<msg::RunControl>::member(own, wire::kRunControl), dds::Error)
        << "it would learn the token";
  }
  fs::create_directory(dir_ / "thief");
  const auto copy = [&](const std::string& from, const std::string& to) {
    fs::copy_file(dir_ / "keys" / from, dir_ / "thief" / to, fs::copy_options::overwrite_existing);
  };
  for (const std::string file : {"identity_ca.pem", "permissions_ca.pem", "governance.p7s"}) copy(file, file);
  fs::create_directory(dir_ / "thief/report");
  for (const std::string file : {"report/certificate.pem", "report/key.pem"}) copy(file, file);
  copy("control/permissions.p7s", "report/permissions.p7s");
  const Variable other("CONSTRICTOR_SECURITY", (dir_ / "thief").string());
  EXPECT_THROW(dds::Domain(domain_of(launcher), dds::Reach::kLoopback, "report"), dds::Error)
      << "the rights of control, with the certificate of report";
  {
    // The thief's own software trusts an authority of the thief, which grants the operator's rights.
    const cli::Authority own(dir_ / "thief/own.pem", dir_ / "thief/own.key.pem", "thief", 1);
    fs::copy_file(dir_ / "thief/own.pem", dir_ / "thief/permissions_ca.pem", fs::copy_options::overwrite_existing);
    std::ofstream(dir_ / "thief/governance.p7s") << own.sign(cli::governance_document());
    std::ofstream(dir_ / "thief/report/permissions.p7s")
        << own.sign(cli::permissions_document(cli::subject_of("report"), cli::rights_of_operator(), 1));
    const dds::Domain thief(domain_of(launcher), dds::Reach::kLoopback, "report");
    const dds::Writer<msg::EmergencyStop> stop(thief.participant(), wire::kEmergencyStop);
    const auto states = dds::Reader<msg::RunState>::member(thief.participant(), wire::kRunState);
    EXPECT_FALSE(eventually([&] { return states.writers() > 0 || stop.readers() > 0; }, 2s))
        << "the run's processes must refuse rights that the thief has signed";
  }
  launcher.signal(SIGTERM);
  EXPECT_TRUE(launcher.wait(20s));
}

TEST_F(Secure, MissingAndExpiredFilesAreNamedBeforeAnythingStarts) {
  const cli::Authority authority(dir_ / "keys/identity_ca.pem", dir_ / "keys/authority/identity_ca.key.pem", "", 1);
  const cli::Identity expired = authority.issue("navigation", -1);
  cli::write_key(dir_ / "keys/navigation/key.pem", *expired.key);
  cli::write_certificate(dir_ / "keys/navigation/certificate.pem", *expired.certificate);
  fs::remove(dir_ / "keys/control/permissions.p7s");
  Process launcher = run(10, "refused", {"--secure", keys()});
  EXPECT_EQ(launcher.wait(20s), exit_status::kConfiguration);
  const std::string text = launcher.errors();
  EXPECT_NE(text.find("navigation/certificate.pem: the certificate has expired"), std::string::npos) << text;
  EXPECT_NE(text.find("control/permissions.p7s: cannot be read"), std::string::npos) << text;
  EXPECT_NE(text.find("constrictor keys"), std::string::npos) << text;
  make_keys("keys");  // renews them with the same authorities
  Process again = run(10, "accepted", {"--secure", keys()});
  EXPECT_EQ(again.wait(40s), exit_status::kOk) << again.output() << again.errors();
}

}  // namespace
}  // namespace constrictor::testing
