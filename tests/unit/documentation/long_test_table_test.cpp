// The table of the long tests in tests/README.md against the tests that the build declares.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "support/project.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The first group of each match.
Names found_in(const std::string& text, const std::regex& pattern) {
  Names names;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) names.insert((*at)[1].str());
  return names;
}

// A long test is a program whose name ends with _long_test, or a test of another kind that is called Long.NAME. A
// program with another name, such as hostile_million_test, may be in the table, too.
TEST(LongTestTable, NamesEveryLongTest) {
  static const std::regex declaration("(?:\\(|\"|NAME )([a-z]\\w*_long_test|Long\\.[A-Z]\\w*)\\b");
  Names declared;
  for (const auto& entry : fs::recursive_directory_iterator(testing::source_path("tests")))
    if (entry.path().filename() == "CMakeLists.txt") declared.merge(found_in(text_of(entry.path()), declaration));
  EXPECT_GT(declared.size(), 20u);
  static const std::regex row("\\n\\| `(\\w+_long_test|Long\\.\\w+)` \\|");
  EXPECT_EQ(found_in(text_of(testing::source_path("tests/README.md")), row), declared);
}

}  // namespace
}  // namespace constrictor
