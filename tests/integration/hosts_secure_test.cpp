// Secured runs on two hosts: the launcher sends each host the keys of its own processes, and they are removed with the
// run.
#include "integration/hosts_fixture.hpp"

namespace constrictor::testing {
namespace {

class HostsSecure : public Hosts {
 protected:
  void SetUp() override { make_keys("hosts.yaml"); }
  void make_keys(const std::string& manifest) const {
    Process keys = command({"keys", keys_.string(), "--manifest", (dir_ / manifest).string()});
    ASSERT_EQ(keys.wait(60s), exit_status::kOk) << keys.output() << keys.errors();
  }
  [[nodiscard]] Process doctor() const {
    return command({"doctor", "--manifest", (dir_ / "hosts.yaml").string(), "--secure", keys_.string()});
  }
  /// The files with keys on the other host, as paths below the agent's folder of keys.
  [[nodiscard]] std::map<std::string, fs::perms> keys_there() const {
    std::map<std::string, fs::perms> found;
    for (const auto& folder : fs::directory_iterator(there_ / "constrictor")) {
      if (!folder.is_directory() || !fs::exists(folder.path() / "keys")) continue;
      EXPECT_EQ(folder.status().permissions(), fs::perms::owner_all) << folder.path();
      for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "keys")) {
        if (entry.is_regular_file())
          found[fs::relative(entry.path(), folder.path() / "keys")] = entry.status().permissions();
      }
    }
    return found;
  }

  const fs::path keys_ = dir_ / "keys";
};

TEST_F(HostsSecure, EachHostGetsTheKeysOfItsOwnProcessesForTheTimeOfTheRun) {
  ASSERT_EQ(run_there(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run_there(300, "two", {"--secure", keys_.string(), "--pace", "2x"});
  // The short run may be over when its progress is shown, and the keys with it.
  std::map<std::string, fs::perms> found;
  EXPECT_TRUE(eventually([&] {
    try {
      found = keys_there();
    } catch (const fs::filesystem_error&) {
      return false;  // a folder came or went while it was read
    }
    return found.size() >= 12;
  })) << launcher.output();
  std::set<std::string> names, expected{"identity_ca.pem", "permissions_ca.pem", "governance.p7s"};
  for (const std::string identity : {"navigation", "control", "report"}) {
    for (const char* file : {"/certificate.pem", "/key.pem", "/permissions.p7s"}) expected.insert(identity + file);
  }
  for (const auto& [path, permissions] : found) {
    names.insert(path);
    EXPECT_EQ(permissions, fs::perms::owner_read | fs::perms::owner_write) << path;
  }
  EXPECT_EQ(names, expected) << "no keys of authorities, of the operator, or of processes of other hosts";
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(state_hash("two"), state_hash("one"));
  EXPECT_NE(state_hash("one"), "none");
  expect_nothing_left();
}

TEST_F(HostsSecure, KeysThatTheManifestPutsOnTheHostAreLeftThere) {
  std::ifstream file(dir_ / "hosts.yaml");
  std::string manifest(std::istreambuf_iterator<char>(file), {});
  fs::copy(keys_, dir_ / "own", fs::copy_options::recursive);
  for (const std::string name : {"navigation", "control", "report"}) {
    manifest = replaced(manifest, "[" + name + "],",
                        "[" + name + "], environment: ['CONSTRICTOR_SECURITY=" + (dir_ / "own").string() + "'],");
    fs::remove_all(keys_ / name);  // so that nothing could be sent
  }
  write("hosts.yaml", manifest);
  Process launcher = run_there(300, "two", {"--secure", keys_.string()});
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_TRUE(fs::exists(dir_ / "own/control/key.pem"));
  expect_nothing_left();
}

TEST_F(HostsSecure, TheDoctorTriesTheKeysOnEachHostAndRemovesThem) {
  Process well = doctor();
  EXPECT_EQ(well.wait(60s), exit_status::kOk) << well.output() << well.errors();
  EXPECT_NE(well.output().find("3 identities in order"), std::string::npos) << well.output();
  expect_nothing_left();
  write("keys/control/certificate.pem", "no certificate");
  Process damaged = doctor();
  EXPECT_EQ(damaged.wait(60s), exit_status::kConfiguration) << damaged.output();
  EXPECT_NE(damaged.errors().find("control/certificate.pem: found no certificate"), std::string::npos)
      << damaged.errors();
  Process launcher = run_there(300, "two", {"--secure", keys_.string()});
  EXPECT_EQ(launcher.wait(60s), exit_status::kConfiguration) << launcher.output();
  EXPECT_TRUE(members().empty());
  expect_nothing_left();
}

}  // namespace
}  // namespace constrictor::testing
