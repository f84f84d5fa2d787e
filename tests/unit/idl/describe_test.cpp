// The generator of descriptions: what it reads from the IDL, and how it reports what it cannot read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "constrictor/hex.hpp"
#include "constrictor/messages.hpp"
#include "constrictor/reflect.hpp"
#include "constrictor/sha256.hpp"
#include "idl/generator/idl_parser.hpp"
#include "random_message.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using generator::Model;
using generator::parse_idl;

Model parsed(const std::string& text) {
  Model model;
  parse_idl("dir/made_up.idl", text, model);
  return model;
}

std::string error_of(const std::string& text) {
  try {
    parsed(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(IdlParser, ReadsFieldsAnnotationsAndComments) {
  const Model model = parsed(
      "module a { module b {\nconst long kN = 3;\n// First line.\n// Second line.\n@final struct S {\n"
      "  @key string<31> name;\n  @range(min=-1.5, max=2) double x; double y;  // [m] NaN unknown\n"
      "  unsigned long long count[kN];\n  sequence<octet> data;\n};\n}; };\n");
  ASSERT_EQ(model.structs.size(), 1u);
  const auto& s = model.structs[0];
  EXPECT_EQ(s.comment, "First line. Second line.");
  EXPECT_EQ(s.file, "made_up.idl");
  ASSERT_EQ(s.fields.size(), 5u);
  EXPECT_TRUE(s.fields[0].is_key);
  EXPECT_EQ(s.fields[0].string_bound, 31u);
  EXPECT_TRUE(s.fields[1].has_range);
  EXPECT_EQ(s.fields[1].min, "-1.5");
  EXPECT_EQ(s.fields[1].max, "2");
  EXPECT_EQ(s.fields[1].comment, "[m] NaN unknown");
  EXPECT_EQ(s.fields[2].comment, "[m] NaN unknown");
  EXPECT_EQ(s.fields[3].array_length, 3u);
  EXPECT_EQ(s.fields[3].type, "std::uint64_t");
  EXPECT_TRUE(s.fields[4].is_sequence);
}

TEST(IdlParser, JoinsTheCommentAboveAFieldAndTheOneBehindIt) {
  const Model model = parsed(
      "@final struct S {\n  long a;  // of a\n  // [m] above b,\n  // in two lines\n  long b;  // behind b\n  long "
      "c;\n};");
  const auto& fields = model.structs.at(0).fields;
  EXPECT_EQ(fields.at(0).comment, "of a");
  EXPECT_EQ(fields.at(1).comment, "[m] above b, in two lines behind b");
  EXPECT_EQ(fields.at(2).comment, "");
}

TEST(IdlParser, RemovesTheEscapeFromANameThatIsAKeyword) {
  EXPECT_EQ(parsed("@final struct S {\n  long _component;\n};").structs.at(0).fields.at(0).name, "component");
}

TEST(IdlParser, ReportsFileAndLineOfTextThatItCannotRead) {
  EXPECT_EQ(error_of("module a {\n@final struct S {\n  map<long, long> m;\n};\n};"),
            "dir/made_up.idl:3: found type 'map', which is not defined before");
  EXPECT_EQ(error_of("enum E { A };"), "dir/made_up.idl:1: found 'enum'; accepted: module, const, @final struct");
  EXPECT_EQ(error_of("@final struct S {\n  @optional long x;\n};"),
            "dir/made_up.idl:2: found @optional; accepted: @key, @range(min=, max=)");
  EXPECT_EQ(error_of("@final struct S {\n  long x[kUnknown];\n};"),
            "dir/made_up.idl:2: found 'kUnknown', accepted a number or a constant");
  EXPECT_EQ(error_of("@final struct S {\n  long x"), "dir/made_up.idl:2: found the end of the file");
}

std::string idl_text(const std::string& name) {
  std::ifstream file(testing::source_path("idl/constrictor/" + name + ".idl"), std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const char* const kFiles[] = {"common", "plant",  "hardware", "simulation", "camera", "perception", "guidance",
                              "task",   "motion", "mission",  "parameter",  "log",    "barrier"};

/// Counts over all fields of all types.
struct Counter {
  int ranged = 0;
  int keys = 0;
  int constants = 0;
  template <class T>
  void operator()(const FieldInfo& info, T&) {
    ranged += info.has_range ? 1 : 0;
    keys += info.is_key ? 1 : 0;
    constants += info.constants ? 1 : 0;
  }
};

TEST(Descriptions, HoldEveryAnnotationOfTheFiles) {
  std::ptrdiff_t ranges = 0;
  std::ptrdiff_t keys = 0;
  std::ptrdiff_t constants = 0;
  std::ptrdiff_t ranged_constants = 0;
  for (const char* name : kFiles) {
    const std::string whole = idl_text(name);
    // Without comments, because one of them explains @range.
    const std::string text = std::regex_replace(whole, std::regex("//[^\n]*"), "");
    const auto count = [](const std::string& in, const char* pattern) {
      const std::regex regex(pattern);
      return std::distance(std::sregex_iterator(in.begin(), in.end(), regex), std::sregex_iterator());
    };
    ranges += count(text, "@range\\(");
    keys += count(text, "@key ");
    constants += count(whole, "octet [a-z_]+(\\[\\w+\\])?; *// k[A-Z][a-z]+\\.\\.\\.");
    ranged_constants += count(whole, "@range[^\n;]* octet [a-z_]+; *// k[A-Z][a-z]+\\.\\.\\.");
  }
  Counter counter;
  testing::for_each_type(AllMessages{}, [&]<class T>() {
    T message{};
    Description<T>::visit(message, counter);
  });
  EXPECT_EQ(counter.constants, constants);
  EXPECT_EQ(counter.ranged, ranges + constants - ranged_constants);  // a group of constants is a range as well
  EXPECT_GT(constants, 30);
  EXPECT_EQ(counter.keys, keys);
  EXPECT_GT(keys, 20);
}

// idlc accepts names that stricter compilers, such as Fast DDS's, reject: the keywords of OMG IDL 4.2, in upper or
// lower case, unless they are escaped by an underscore.
TEST(Descriptions, ContainNoKeywordOfOtherIdlCompilers) {
  const std::set<std::string> keywords{
      "abstract",   "alias",     "any",       "attribute",   "bitfield",  "bitmask", "bitset",   "case",
      "char",       "component", "connector", "consumes",    "context",   "custom",  "default",  "emits",
      "enum",       "eventtype", "exception", "factory",     "false",     "finder",  "fixed",    "getraises",
      "home",       "import",    "in",        "inout",       "interface", "local",   "manages",  "map",
      "mirrorport", "multiple",  "native",    "object",      "oneway",    "out",     "port",     "porttype",
      "primarykey", "private",   "provides",  "public",      "publishes", "raises",  "readonly", "setraises",
      "supports",   "switch",    "true",      "truncatable", "typedef",   "typeid",  "typename", "typeprefix",
      "union",      "uses",      "valuebase", "valuetype",   "void",      "wchar",   "wstring"};
  const std::regex word("[A-Za-z_][A-Za-z0-9_]*");
  for (const char* name : kFiles) {
    const std::string text = std::regex_replace(idl_text(name), std::regex("//[^\n]*"), "");
    for (auto it = std::sregex_iterator(text.begin(), text.end(), word); it != std::sregex_iterator(); ++it) {
      std::string lower = it->str();
      std::transform(lower.begin(), lower.end(), lower.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      EXPECT_FALSE(keywords.contains(lower)) << name << ".idl: " << it->str() << " is a keyword; write _" << it->str();
    }
  }
}

TEST(Descriptions, HashIsOverTheFilesOfThisBuild) {
  std::string all;
  for (const char* name : kFiles) all += idl_text(name);
  Sha256 hash;
  hash.update(std::as_bytes(std::span(all)));
  EXPECT_EQ(hex(hash.finish()), msg::kIdlHash);
}

TEST(Descriptions, HoldUnitRangeAndUnknownValue) {
  const auto& timeout = Description<msg::TaskParameters>::k_timeout_s;
  EXPECT_STREQ(timeout.name, "timeout_s");
  EXPECT_STREQ(timeout.unit, "s");
  EXPECT_TRUE(timeout.nan_allowed);
  EXPECT_EQ(timeout.max, 3600.0);
  EXPECT_STREQ(Description<msg::JointState>::kFile, "plant.idl");
  EXPECT_TRUE(Description<msg::JointState>::k_robot_id.is_key);
  EXPECT_FALSE(Description<msg::JointState>::k_position_rad.nan_allowed);
}

}  // namespace
}  // namespace constrictor
