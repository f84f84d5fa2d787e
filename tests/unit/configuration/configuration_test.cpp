// Each error message names file, line, key, what was found and what is accepted.
#include "configuration/configuration.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace constrictor {
namespace {

Configuration parse(const std::string& text) { return Configuration::parse(text, "x.yaml"); }

/// The error message; empty if there was no error.
std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return {};
}

TEST(Configuration, ReadsEveryKindOfValue) {
  Configuration root =
      parse("a: 1.5e-3\nb: -7\nc: true\nd: green\ne: [1, 2.5]\nf: [x, y]\ng: {h: +3}\ni: [{j: 1}, {j: 2}]\n");
  EXPECT_DOUBLE_EQ(root.number("a", {0, 1}), 0.0015);
  EXPECT_EQ(root.integer("b", -10, 10), -7);
  EXPECT_TRUE(root.flag("c"));
  EXPECT_EQ(root.text("d", {"green", "red"}), "green");
  EXPECT_EQ(root.numbers("e", {0, 3}, 2, 2), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(root.texts("f"), (std::vector<std::string>{"x", "y"}));
  EXPECT_DOUBLE_EQ(root.section("g").number("h", {0, 5}), 3);
  std::vector<Configuration> items = root.list("i");
  ASSERT_EQ(items.size(), 2U);
  EXPECT_EQ(items[1].integer("j", 0, 5), 2);
  EXPECT_NO_THROW(root.finish());
}

TEST(Configuration, UsesFallbacksWhereAKeyIsAbsent) {
  Configuration root = parse("{}");
  EXPECT_DOUBLE_EQ(root.number("a", {0, 1}, 0.5), 0.5);
  EXPECT_EQ(root.integer("b", 0, 1, 1), 1);
  EXPECT_FALSE(root.flag("c", false));
  EXPECT_EQ(root.text("d", {}, "x"), "x");
  EXPECT_DOUBLE_EQ(root.section("e", false).number("f", {0, 9}, 4), 4);
  EXPECT_TRUE(root.list("g", false).empty());
  EXPECT_FALSE(root.has("h"));
}

TEST(Configuration, AnEmptyFileIsAnEmptyMap) { EXPECT_NO_THROW(parse("").finish()); }

TEST(Configuration, NamesANumberOutOfRange) {
  EXPECT_EQ(error_of([] {
              parse("\nmodule:\n  mass_kg: -1\n").section("module").number("mass_kg", {0.01, 10});
            }),
            "x.yaml:3: module.mass_kg: found -1, accepted 0.01 to 10");
}

TEST(Configuration, RefusesNotANumberAndInfinity) {
  for (const std::string value : {".nan", "nan", ".inf", "-inf", "1e999", "12 m", "abc", "0x10"}) {
    EXPECT_EQ(error_of([&] {
                parse("a: " + value).number("a", {-1e300, 1e300});
              }),
              "x.yaml:1: a: found " + value + ", accepted -1e+300 to 1e+300");
  }
}

TEST(Configuration, NamesAMissingKeyAtItsMap) {
  EXPECT_EQ(error_of([] {
              parse("x: 1\nmodule:\n  length_m: 1\n").section("module").number("mass_kg", {0, 1});
            }),
            "x.yaml:3: module.mass_kg: found nothing, accepted 0 to 1");
}

/// The error that `radius_m` is missing in a file with this key.
std::string error_without_radius(const std::string& key) {
  return error_of([&] {
    Configuration root = parse("name: x\n" + key + ": 0.1\n");
    (void)root.text("name");
    (void)root.number("radius_m", {0, 1});
  });
}

TEST(Configuration, NamesTheKeyThatIsMisspeltForAMissingOne) {
  for (const char* key : {"radus_m", "raduis_m", "Radius_m", "radius", "radius_mm"}) {
    EXPECT_EQ(error_without_radius(key), std::string("x.yaml:1: radius_m: found nothing, accepted 0 to 1; line 2 has a "
                                                     "key '") +
                                             key + "': rename it if it is meant");
  }
  for (const char* key : {"height_m", "min_radius_m", "r"})
    EXPECT_EQ(error_without_radius(key), "x.yaml:1: radius_m: found nothing, accepted 0 to 1");
  EXPECT_EQ(error_of([] { parse("modul: {a: 1}").section("module"); }),
            "x.yaml:1: module: found nothing, accepted a map; line 1 has a key 'modul': rename it if it is meant");
  EXPECT_EQ(error_of([] { parse("object: []").list("objects"); }),
            "x.yaml:1: objects: found nothing, accepted a list of maps; line 1 has a key 'object': rename it if it is "
            "meant");
  // Keys that have their own meaning are not named.
  EXPECT_EQ(error_of([] {
              parse("max_rad: 1").number("min_rad", {0, 1});
            }),
            "x.yaml:1: min_rad: found nothing, accepted 0 to 1");
  EXPECT_EQ(error_of([] { parse("x_m: 1").number("y_m", {0, 1}); }), "x.yaml:1: y_m: found nothing, accepted 0 to 1");
  EXPECT_EQ(error_of([] {
              Configuration root = parse("points: 1");
              (void)root.number("points", {0, 1});
              (void)root.number("point", {0, 1});
            }),
            "x.yaml:1: point: found nothing, accepted 0 to 1");
}

TEST(Configuration, NamesAnEmptyValue) {
  EXPECT_EQ(error_of([] {
              parse("a:\n").number("a", {0, 1}, 0.5);
            }),
            "x.yaml:1: a: found an empty value, accepted 0 to 1");
}

TEST(Configuration, NamesAWrongInteger) {
  EXPECT_EQ(error_of([] { parse("a: 1.5").integer("a", 0, 3); }),
            "x.yaml:1: a: found 1.5, accepted a whole number 0 to 3");
  EXPECT_EQ(error_of([] { parse("a: 99999999999999999999").integer("a", 0, 3); }),
            "x.yaml:1: a: found 99999999999999999999, accepted a whole number 0 to 3");
}

TEST(Configuration, NamesAWrongFlag) {
  EXPECT_EQ(error_of([] { parse("a: yes").flag("a"); }), "x.yaml:1: a: found yes, accepted true or false");
}

TEST(Configuration, NamesAWrongChoice) {
  EXPECT_EQ(error_of([] {
              parse("a: pink").text("a", {"green", "red"});
            }),
            "x.yaml:1: a: found pink, accepted one of green, red");
  EXPECT_EQ(error_of([] {
              parse("a: gren").text("a", {"green", "red"});
            }),
            "x.yaml:1: a: found gren, accepted one of green, red, did you mean 'green'?");
  EXPECT_EQ(error_of([] { parse("a: [1]").text("a"); }), "x.yaml:1: a: found a list of 1, accepted a text");
  EXPECT_EQ(error_of([] {
              parse("a:\n- red\n- pink").texts("a", {"red", "blue"});
            }),
            "x.yaml:3: a[1]: found pink, accepted one of red, blue");
}

TEST(Configuration, NamesAListOfTheWrongLengthOrElement) {
  EXPECT_EQ(error_of([] {
              parse("a: [1, 2]").numbers("a", {0, 1}, 3, 3);
            }),
            "x.yaml:1: a: found a list of 2, accepted a list of 3 numbers, each 0 to 1");
  EXPECT_EQ(error_of([] {
              parse("a: 1").numbers("a", {0, 1}, 1, 4);
            }),
            "x.yaml:1: a: found 1, accepted a list of 1 to 4 numbers, each 0 to 1");
  EXPECT_EQ(error_of([] {
              parse("a:\n- 0.5\n- 7\n").numbers("a", {0, 1}, 1, 4);
            }),
            "x.yaml:3: a[1]: found 7, accepted 0 to 1");
}

TEST(Configuration, NamesAScalarWhereAMapOrListBelongs) {
  EXPECT_EQ(error_of([] { parse("- 1\n"); }), "x.yaml:1: (root): found a list of 1, accepted a map");
  EXPECT_EQ(error_of([] { parse("a: 1").section("a"); }), "x.yaml:1: a: found 1, accepted a map");
  EXPECT_EQ(error_of([] { parse("b: 1").section("a"); }), "x.yaml:1: a: found nothing, accepted a map");
  EXPECT_EQ(error_of([] { parse("a: 1").list("a"); }), "x.yaml:1: a: found 1, accepted a list of maps");
  EXPECT_EQ(error_of([] { parse("a: [{b: 1}, 2]").list("a"); }), "x.yaml:1: a[1]: found 2, accepted a map");
}

TEST(Configuration, NamesAnUnknownKeyAndTheKnownOnes) {
  EXPECT_EQ(error_of([] {
              Configuration root = parse("m:\n  speed: 1\n  sped: 2\n");
              Configuration section = root.section("m");
              section.number("speed", {0, 9});
              section.number("gain", {0, 9}, 1);
              section.finish();
            }),
            "x.yaml:3: m.sped: found an unknown key, accepted the keys gain, speed, did you mean 'speed'?");
}

TEST(Configuration, NamesAKeyGivenTwice) {
  EXPECT_EQ(error_of([] { parse("a: 1\nb: 2\na: 3\n"); }),
            "x.yaml:3: a: found the key a second time, accepted each key once");
}

TEST(Configuration, NamesTheLineOfASyntaxError) {
  const std::string text = error_of([] { parse("a: 1\nb: [1, 2\nc: }\n"); });
  EXPECT_TRUE(text.starts_with("x.yaml:3: (syntax): found ")) << text;
  EXPECT_TRUE(text.ends_with("comma missing?)")) << text;
  EXPECT_EQ(error_of([] { parse("a: {b: [1, 2] c: 3}\n"); }),
            "x.yaml:1: (syntax): found a list or map that is not closed, accepted valid YAML (is a ']', '}' or comma "
            "missing?)");
}

TEST(Configuration, NamesAMissingFile) {
  EXPECT_EQ(error_of([] { Configuration::load("/nonexistent/x.yaml"); }),
            "/nonexistent/x.yaml: found no readable file, accepted a YAML file");
}

TEST(Configuration, NamesKeysOfNestedLists) {
  EXPECT_EQ(error_of([] {
              Configuration root = parse("objects:\n- radius_m: 1\n- radius_m: 9\n");
              for (Configuration& item : root.list("objects")) item.number("radius_m", {0, 2});
            }),
            "x.yaml:3: objects[1].radius_m: found 9, accepted 0 to 2");
}

TEST(Configuration, GivesAnyValueAsYamlOnOneLine) {
  Configuration root = parse("mission:\n  sequence:\n    - green\n    - red\n  line_colour: blue\nname: x\n");
  const std::string mission = root.one_line("mission");
  EXPECT_EQ(mission, "{sequence: [green, red], line_colour: blue}");
  Configuration again = Configuration::parse(mission, "again");
  EXPECT_EQ(again.texts("sequence"), (std::vector<std::string>{"green", "red"}));
  EXPECT_EQ(parse("mission: {sequence: [], line_colour: blue}").one_line("mission"),
            "{sequence: [], line_colour: blue}");
  EXPECT_EQ(root.one_line("name"), "x");
  EXPECT_EQ(root.one_line("missing"), "");
}

}  // namespace
}  // namespace constrictor
