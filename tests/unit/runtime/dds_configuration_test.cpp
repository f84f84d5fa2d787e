// deploy/cyclonedds/loopback.xml, for other programs, has the settings that this project's programs have built in.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "cyclone/domain.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

std::string without_comments_and_indentation(const std::string& xml) {
  return std::regex_replace(std::regex_replace(xml, std::regex("<!--[^]*?-->"), ""), std::regex(">\\s+"), ">");
}

TEST(DdsConfiguration, OfOtherProgramsIsTheBuiltInOne) {
  std::ifstream file(testing::source_path("deploy/cyclonedds/loopback.xml"));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::string expected = without_comments_and_indentation(text);
  expected.erase(0, expected.find("<CycloneDDS>"));
  EXPECT_EQ(without_comments_and_indentation(dds::loopback_configuration()), expected);
}

}  // namespace
}  // namespace constrictor
