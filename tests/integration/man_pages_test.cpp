// The manual pages and --version.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "constrictor/messages.hpp"
#include "introspection_fixture.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(Introspection, EverySubcommandHasAManualPageWithoutErrors) {
  const fs::path pages = dir_ / "man";
  ASSERT_EQ(command({"man-pages", pages.string()}), 0) << output_;
  // The subcommands, as --help lists them: two blanks, the name, and its description.
  ASSERT_EQ(command({"--help"}), 0);
  std::istringstream help(output_.substr(output_.find("Subcommands:")));
  int subcommands = 0;
  std::smatch match;
  for (std::string line; std::getline(help, line);) {
    if (!std::regex_match(line, match, std::regex("  ([a-z-]+) .*"))) continue;
    ++subcommands;
    EXPECT_TRUE(fs::exists(pages / ("constrictor-" + match[1].str() + ".1"))) << line;
  }
  EXPECT_GT(subcommands, 30);
  EXPECT_EQ(std::distance(fs::directory_iterator(pages), fs::directory_iterator{}), subcommands + 1);
  const std::string topic = text_of(pages / "constrictor-topic.1");
  for (const char* part : {"\\fB\\-\\-filter\\fR", ".SS \"constrictor topic pub\"", ".SH EXIT STATUS\n.TP\n.B 0\ndone",
                           "constrictor topic hz joint_state camera/image"})
    EXPECT_NE(topic.find(part), std::string::npos) << part << " in\n" << topic;

  EXPECT_EQ(command({"man-pages", "/proc/pages"}), 70) << output_;
  EXPECT_NE(output_.find("DIR: found /proc/pages, which cannot be made ("), std::string::npos) << output_;
  EXPECT_EQ(output_.find("filesystem error"), std::string::npos) << output_;

  if (!fs::exists("/usr/bin/mandoc")) GTEST_SKIP() << "mandoc is not installed";
  std::vector<std::string> lint = {"/usr/bin/mandoc", "-T", "lint", "-W", "warning"};
  for (const auto& page : fs::directory_iterator(pages)) lint.push_back(page.path().string());
  Process mandoc(lint);
  EXPECT_EQ(mandoc.wait(std::chrono::seconds(20)), 0);
  EXPECT_EQ(mandoc.output() + mandoc.errors(), "");
}

TEST_F(Introspection, VersionNamesReleaseRevisionMessagesAndDds) {
  for (const std::string name : {"constrictor", "constrictor_host"}) {
    Process process({program(name), "--version"});
    ASSERT_EQ(process.wait(std::chrono::seconds(20)), 0) << process.errors();
    const std::regex expected(name +
                              " \\d+\\.\\d+\\.\\d+\ngit ([0-9a-f]{12} of \\d{4}-\\d\\d-\\d\\d.*|not known.*)\nIDL " +
                              std::string(msg::kIdlHash) + "\nCyclone DDS libddsc\\.so\\.[0-9.]+ [0-9a-f]+\n");
    EXPECT_TRUE(std::regex_match(process.output(), expected)) << process.output();
  }
}

}  // namespace
}  // namespace constrictor::testing
