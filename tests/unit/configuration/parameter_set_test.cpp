// One row declares a parameter: its default, its file key, its errors and its description agree with each other.
#include "configuration/parameter_set.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "configuration/closest_name.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

struct WheelConfig : ParameterSet {
  double radius_m = add(radius_m, "radius_m", 0.1, "m", {0.01, 1.0}, Changes::kAtStart, "Radius of the wheel");
};

struct CartConfig : ParameterSet {
  double speed_m_s = add(speed_m_s, "drive.speed_m_s", 0.5, "m/s", {0.0, 2.0}, Changes::kWhileRunning, "Top speed");
  int wheels = add(wheels, "drive.wheels", 4, "", {3, 8}, Changes::kAtStart, "Number of wheels");
  std::int64_t limit_ticks =
      add(limit_ticks, "limit_ticks", 5'000'000'000, "ticks", {1, 9e15}, Changes::kWhileRunning, "End of the journey");
  bool loud = add(loud, "horn.loud", true, "Whether the horn is loud");
  std::string tune = add(tune, "horn.tune", "low", {"low", "high"}, "Tune of the horn");
  std::string name = add(name, "name", "cart", std::vector<std::string>{}, "Name on the side");
  std::vector<double> gears = add(gears, "gears", {1.0, 2.5}, "", {0.5, 9.0}, {1, 3}, "Ratios of the gears");
  std::uint8_t colour = add(colour, "colour", 2, {"", "green", "red"}, "Colour of the cart");
  std::vector<std::uint8_t> stripes = add(stripes, "stripes", {1}, {"", "green", "red"}, {0, 2}, "Colours of stripes");
  WheelConfig front = add_section(front, "front.wheel");
  WheelConfig rear = add_section(rear, "rear.wheel");

  void complete(Configuration& root) const {
    if (front.radius_m > rear.radius_m) throw root.error("front.wheel.radius_m", "found a larger wheel in front");
    static_cast<void>(root.list("passengers", false));
  }
};

class ParameterSetTest : public ::testing::Test {
 protected:
  [[nodiscard]] CartConfig load(const std::string& text) const {
    const auto file = folder_.path() / "cart.yaml";
    std::ofstream(file) << text;
    return load_parameters<CartConfig>(file);
  }
  /// The error without the folder of the file; empty if there was none.
  [[nodiscard]] std::string error_of(const std::string& text) const {
    try {
      static_cast<void>(load(text));
    } catch (const ConfigurationError& error) {
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return {};
  }
  const testing::TemporaryFolder folder_;
};

TEST_F(ParameterSetTest, FieldsHoldTheDefaultsOfTheirRows) {
  const CartConfig built;
  for (const CartConfig& cart : {built, load(""), load_parameters<CartConfig>({})}) {
    EXPECT_EQ(cart.speed_m_s, 0.5);
    EXPECT_EQ(cart.wheels, 4);
    EXPECT_EQ(cart.limit_ticks, 5'000'000'000);
    EXPECT_TRUE(cart.loud);
    EXPECT_EQ(cart.tune, "low");
    EXPECT_EQ(cart.name, "cart");
    EXPECT_EQ(cart.gears, (std::vector<double>{1.0, 2.5}));
    EXPECT_EQ(cart.colour, 2);
    EXPECT_EQ(cart.stripes, (std::vector<std::uint8_t>{1}));
    EXPECT_EQ(cart.front.radius_m, 0.1);
    EXPECT_EQ(cart.rear.radius_m, 0.1);
    for (const auto& row : cart.describe()) EXPECT_EQ(row.value, row.default_value) << row.key;
  }
}

TEST_F(ParameterSetTest, FileSetsTheFieldsItNames) {
  const CartConfig cart = load(
      "drive: {speed_m_s: 1.25, wheels: 3}\nlimit_ticks: 7\nhorn:\n  loud: false\n  tune: high\nname: a b\n"
      "gears: [0.5, 0.75, 9]\ncolour: green\nstripes: [red, green]\nrear: {wheel: {radius_m: 0.25}}\npassengers: "
      "[{}]\n");
  EXPECT_EQ(cart.speed_m_s, 1.25);
  EXPECT_EQ(cart.wheels, 3);
  EXPECT_EQ(cart.limit_ticks, 7);
  EXPECT_FALSE(cart.loud);
  EXPECT_EQ(cart.tune, "high");
  EXPECT_EQ(cart.name, "a b");
  EXPECT_EQ(cart.gears, (std::vector<double>{0.5, 0.75, 9.0}));
  EXPECT_EQ(cart.colour, 1);
  EXPECT_EQ(cart.stripes, (std::vector<std::uint8_t>{2, 1}));
  EXPECT_EQ(cart.front.radius_m, 0.1);
  EXPECT_EQ(cart.rear.radius_m, 0.25);
}

TEST_F(ParameterSetTest, DescribesEachParameterInYamlNotation) {
  const CartConfig cart = load("gears: [9]\nstripes: []\n");
  std::map<std::string, ParameterRow> rows;
  for (const auto& row : cart.describe()) rows[row.key] = row;
  EXPECT_EQ(rows.size(), 11U);
  EXPECT_EQ(rows["drive.speed_m_s"].accepted, "0 to 2");
  EXPECT_EQ(rows["drive.speed_m_s"].unit, "m/s");
  EXPECT_EQ(rows["drive.speed_m_s"].meaning, "Top speed");
  EXPECT_EQ(rows["drive.speed_m_s"].changes, Changes::kWhileRunning);
  EXPECT_EQ(rows["drive.wheels"].changes, Changes::kAtStart);
  EXPECT_TRUE(rows["drive.wheels"].is_integer);
  EXPECT_EQ(rows["horn.loud"].accepted, "true or false");
  EXPECT_EQ(rows["horn.tune"].accepted, "one of low, high");
  EXPECT_EQ(rows["colour"].accepted, "one of green, red");
  EXPECT_EQ(rows["colour"].value, "red");
  EXPECT_EQ(rows["gears"].default_value, "[1, 2.5]");
  EXPECT_EQ(rows["gears"].value, "[9]");
  EXPECT_EQ(rows["gears"].accepted, "1 to 3 numbers, each 0.5 to 9");
  EXPECT_EQ(rows["stripes"].value, "[]");
}

TEST_F(ParameterSetTest, ErrorsNameLineKeyFoundAndAccepted) {
  EXPECT_EQ(error_of("\ndrive:\n  speed_m_s: 3\n"), "cart.yaml:3: drive.speed_m_s: found 3, accepted 0 to 2");
  EXPECT_EQ(error_of("drive:\n  wheels: 3.5\n"),
            "cart.yaml:2: drive.wheels: found 3.5, accepted a whole number 3 to 8");
  EXPECT_EQ(error_of("colour: pink\n"), "cart.yaml:1: colour: found pink, accepted one of green, red");
  EXPECT_EQ(error_of("gears:\n"),
            "cart.yaml:1: gears: found an empty value, accepted a list of 1 to 3 numbers, "
            "each 0.5 to 9");
  EXPECT_EQ(error_of("stripes: [red, red, red]\n"), "cart.yaml:1: stripes: found 3 names, accepted 0 to 2");
  EXPECT_EQ(error_of("a: 1\n").rfind("cart.yaml:1: a: found an unknown key, accepted the keys colour, drive, ", 0), 0U);
  EXPECT_EQ(error_of("front:\n  wheel:\n    radius: 1\n"),
            "cart.yaml:3: front.wheel.radius: found an unknown key, accepted the keys radius_m, did you mean "
            "'radius_m'?");
}

TEST_F(ParameterSetTest, CheckThatSpansRowsNamesTheLineOfItsKey) {
  EXPECT_EQ(error_of("name: x\nfront:\n  wheel:\n    radius_m: 0.5\n"),
            "cart.yaml:4: front.wheel.radius_m: found a larger wheel in front");
}

TEST_F(ParameterSetTest, CopiesHaveRowsOfTheirOwnFields) {
  CartConfig cart = load("drive: {speed_m_s: 1}\n");
  CartConfig copy = cart;
  for (const auto& row : copy.rows()) {
    if (row.text.key == "drive.speed_m_s") row.set(copy.field(row), 2.0);
  }
  EXPECT_EQ(copy.speed_m_s, 2.0);
  EXPECT_EQ(cart.speed_m_s, 1.0);
}

TEST(ParameterRow, ThatContradictsItselfIsABug) {
  struct Set : ParameterSet {
    double a = 0.0;
    std::uint8_t b = 0;
    std::string c;
  } set;
  const auto add = [&](const char* key, double fallback, const char* meaning) {
    return set.add(set.a, key, fallback, "", {0.0, 1.0}, Changes::kAtStart, meaning);
  };
  EXPECT_NO_THROW(add("a", 0.5, "A number"));
  EXPECT_THROW(add("a", 0.5, "A number"), std::logic_error) << "a second row with this key";
  EXPECT_THROW(add("b", 1.5, "A number"), std::logic_error) << "a default out of bounds";
  EXPECT_THROW(add("c", 0.5, ""), std::logic_error) << "no meaning";
  EXPECT_THROW(add("", 0.5, "A number"), std::logic_error) << "no key";
  EXPECT_THROW(set.add(set.b, "d", 0, {"", "green"}, "A colour"), std::logic_error) << "a default without a name";
  EXPECT_THROW(set.add(set.c, "e", "x", {"y"}, "A text"), std::logic_error) << "a default that is no choice";
}

TEST(ClosestName, IsTheCandidateWithTheFewestWrongLetters) {
  const std::vector<std::string> names{"physics", "planner", "perception", "input"};
  EXPECT_EQ(closest_name("pysics", names), "physics");
  EXPECT_EQ(closest_name("PLANER", names), "planner");
  EXPECT_EQ(closest_name("inptu", names), "input");
  EXPECT_EQ(closest_name("camera", names), "");
  EXPECT_EQ(closest_name("plan", names), "planner") << "the beginning of a name";
  EXPECT_EQ(closest_name("", names), "");
  EXPECT_EQ(closest_name(std::string(10000, 'p'), names), "");
  EXPECT_EQ(did_you_mean("perceptoin", names), ", did you mean 'perception'?");
  EXPECT_EQ(did_you_mean("x", names), "");
}

}  // namespace
}  // namespace constrictor
