// A fixture for tests that examine, with `constrictor`, a run of toy components and programs of other projects.
#pragma once

#include <sstream>

#include "integration/cli_fixture.hpp"

namespace constrictor::testing {

class Introspection : public CliFixture {
 protected:
  static inline const std::string kManifest =
      case_study_manifest(30, "  - {components: [physics], program: toy_host}\n");
  static constexpr const char* kMembers = "  - {components: [navigation, control], program: toy_host}\n";

  [[nodiscard]] Process foreign(std::uint32_t domain, const std::string& mode) const {
    Process process({program("foreign_talker"), std::to_string(domain), mode}, environment_);
    EXPECT_TRUE(process.wait_for("talking", std::chrono::seconds(20))) << process.errors();
    return process;
  }
  /// Starts a run of toys that makes at most 50 ticks per second and does not end before the test does. `members` are
  /// the lines of the manifest for the processes beside the plant.
  [[nodiscard]] Process toys(const std::string& members = kMembers) const {
    write("toys.yaml", kManifest + members);
    write("100000_ticks.yaml", "");
    Process run = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(),
                         "--pace", "1x", "--report", (dir_ / "report").string()});
    EXPECT_TRUE(eventually([&] { return domain() != 0; }));
    return run;
  }
  /// Runs a command with --json, expects the exit status `status`, and returns its standard output as JSON. `output_`
  /// holds its standard output and its standard error.
  nlohmann::json json_of(std::vector<std::string> arguments, int status = 0) {
    arguments.push_back("--json");
    Process process = start(std::move(arguments));
    const auto ended = process.wait(std::chrono::seconds(30));
    output_ = process.output() + process.errors();
    EXPECT_EQ(ended, status) << output_;
    return nlohmann::json::parse(process.output(), nullptr, false);
  }
  /// Names of the faults that `constrictor doctor` finds in a domain.
  std::vector<std::string> faults(std::uint32_t domain) {
    const nlohmann::json found = json_of({"doctor", "--run", std::to_string(domain)}, 1);
    std::vector<std::string> names;
    for (const auto& finding : found.value("findings", nlohmann::json::array())) {
      names.push_back(finding["fault"]);
      EXPECT_FALSE(finding["cure"].get<std::string>().empty());
    }
    return names;
  }
  /// The text in one line, with single blanks between the words: the commands wrap their output at 80 columns.
  [[nodiscard]] static std::string flat(const std::string& text) {
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return line;
  }
};

}  // namespace constrictor::testing
