// What yaml-cpp accepts, but nobody can mean, is refused with its line.
#include "configuration/yaml_document.hpp"

#include <gtest/gtest.h>

#include <string>

#include "configuration/configuration.hpp"

namespace constrictor {
namespace {

std::string refusal(const std::string& text) {
  try {
    (void)parse_yaml(text);
    return "accepted";
  } catch (const YAML::ParserException& error) {
    return std::to_string(error.mark.line + 1) + ": " + error.msg;
  }
}

TEST(YamlDocument, OneDocumentIsAccepted) {
  EXPECT_EQ(parse_yaml("a: 1").size(), 1u);
  EXPECT_EQ(parse_yaml("---\na: 1\n...\n").size(), 1u);
  EXPECT_EQ(parse_yaml("a: 1\n---\n").size(), 1u);
  EXPECT_TRUE(parse_yaml("").IsNull());
  EXPECT_TRUE(parse_yaml("# only a comment\n").IsNull());
  EXPECT_EQ(parse_yaml("a: &x [1, 2]\nb: *x\n")["b"].size(), 2u);
}

TEST(YamlDocument, ASecondDocumentIsRefused) {
  EXPECT_EQ(refusal("a: 1\n---\nb: 2\n"), "3: a second document; only one is read");
  EXPECT_NE(refusal("a: 1\n...\ngarbage: [\n"), "accepted");
}

TEST(YamlDocument, AListOrMapThatIsNotClosedIsCalledSo) {
  EXPECT_EQ(refusal("a: 1\nline: ["), "2: a list or map that is not closed");
  EXPECT_EQ(refusal("a: {b: 1"), "1: a list or map that is not closed");
}

TEST(YamlDocument, AnAliasToAValueThatContainsItIsRefused) {
  for (const char* text : {"a: &x {b: *x}", "a: &x [1, *x]", "- &x {k: [{l: *x}]}"})
    EXPECT_NE(refusal(text).find("an alias to a value that contains it"), std::string::npos) << text;
}

TEST(YamlDocument, AliasesThatMakeASmallFileHugeAreRefused) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) text += ", " + before;
    text += "]\n";
  }
  EXPECT_NE(refusal(text).find("more than 5000000 values"), std::string::npos);
}

TEST(YamlDocument, AConfigurationNamesFileAndLine) {
  try {
    (void)Configuration::parse("a: 1\n---\nb: 2\n", "two.yaml");
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_EQ(std::string(error.what()).find("two.yaml:3: "), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find("a second document"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace constrictor
