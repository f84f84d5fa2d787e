// The parameters of every component follow from their rows: in the shipped YAML file, in the README, and when a file is
// read.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/known_components.hpp"
#include "parameter_tables.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;

TEST(ParameterTables, FollowFromTheRows) {
  for (const auto& file : derived_files(testing::source_path())) {
    EXPECT_EQ(file.error, "");
    EXPECT_EQ(content_of(file.path), file.text)
        << file.path << " is out of date. Run: cmake --build build/release --target parameter_tables\n"
        << "If you have done so, this test is older than the rows: build it again.";
  }
}

std::vector<std::string> components_with_rows() {
  std::vector<std::string> names;
  for (const auto& [name, make] : known_components()) {
    if (make().parameters) names.push_back(name);
  }
  return names;
}

class ParameterTable : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] std::vector<ParameterRow> rows_of(const fs::path& file) const { return factory_.parameters(file); }

  /// A file that holds one key.
  [[nodiscard]] fs::path file_with(const std::string& key, const std::string& value) const {
    std::istringstream keys(key);
    std::string text;
    std::string indent;
    for (std::string part; std::getline(keys, part, '.'); indent += "  ")
      text += (text.empty() ? "" : "\n") + indent + part + ":";
    fs::path file = folder_.path() / "changed.yaml";
    std::ofstream(file) << text << " " << value << "\n";
    return file;
  }
  [[nodiscard]] std::string error_of(const std::string& key, const std::string& value) const {
    try {
      static_cast<void>(rows_of(file_with(key, value)));
      return {};
    } catch (const ConfigurationError& error) {
      return error.what();
    }
  }
  static std::string number(const ParameterRow& row, double value) {
    return row.is_integer ? fmt::format("{}", static_cast<std::int64_t>(value)) : fmt::format("{}", value);
  }

  const testing::TemporaryFolder folder_;
  const ComponentFactory factory_ = known_components().at(GetParam())();
};

TEST_P(ParameterTable, ShippedFileHoldsTheDefaultsAndNamesEveryParameter) {
  const fs::path shipped = testing::source_path(factory_.default_config);
  for (const auto& row : rows_of(shipped)) {
    EXPECT_EQ(row.value, row.default_value) << row.key;
    YAML::Node node = YAML::LoadFile(shipped.string());
    std::istringstream keys(row.key);
    for (std::string key; std::getline(keys, key, '.');) node.reset(node[key]);
    EXPECT_TRUE(node.IsDefined()) << row.key << " is missing in " << shipped;
  }
}

TEST_P(ParameterTable, WhatMayChangeDuringARunFitsIntoItsList) {
  const auto rows = rows_of({});
  for (const auto& row : rows) {
    if (row.changes != Changes::kWhileRunning) continue;
    EXPECT_LT(row.meaning.size(), sizeof(msg::Parameter::doc)) << row.key << ": " << row.meaning;
    EXPECT_LT(row.unit.size(), sizeof(msg::Parameter::unit)) << row.key;
  }
  EXPECT_LE(
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.changes == Changes::kWhileRunning; }),
      msg::kMaxParameters)
      << "declare some of them kAtStart, or raise kMaxParameters in idl/constrictor/parameter.idl";
}

TEST_P(ParameterTable, KeyOfTheFileSetsItsOwnFieldAndNoOther) {
  const auto before = rows_of({});
  for (const auto& row : before) {
    if (!row.is_number) continue;
    // The value is a bound that differs from the default. If the configuration rejects the lower bound because of
    // another parameter, it is the upper one.
    double value = number(row, row.bounds.min) == row.default_value ? row.bounds.max : row.bounds.min;
    if (!error_of(row.key, number(row, value)).empty()) value = row.bounds.max;
    const auto after = rows_of(file_with(row.key, number(row, value)));
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_EQ(after[k].value, before[k].key == row.key ? number(row, value) : before[k].default_value)
          << after[k].key << " when " << row.key << " is set";
    }
  }
}

TEST_P(ParameterTable, ErrorNamesFileLineKeyFoundAndAccepted) {
  for (const auto& row : rows_of({})) {
    if (!row.is_number) continue;
    const double step = row.is_integer ? 1.0 : 1e-3 * (row.bounds.max - row.bounds.min);
    for (const double value : {row.bounds.min - step, row.bounds.max + step}) {
      const std::string error = error_of(row.key, number(row, value));
      const auto line = std::count(row.key.begin(), row.key.end(), '.') + 1;
      EXPECT_EQ(error.rfind(fmt::format("{}:{}: {}: found {}, accepted ", (folder_.path() / "changed.yaml").string(),
                                        line, row.key, number(row, value)),
                            0),
                0U)
          << error;
      const std::string bounds = row.is_integer ? fmt::format("{:.0f} to {:.0f}", row.bounds.min, row.bounds.max)
                                                : fmt::format("{:g} to {:g}", row.bounds.min, row.bounds.max);
      EXPECT_NE(error.find(bounds), std::string::npos) << error;
    }
  }
}

TEST_P(ParameterTable, RejectsUnknownKeys) {
  for (const auto& row : rows_of({})) {
    const std::string error = error_of(row.key + "x", row.default_value);
    EXPECT_NE(error.find(row.key + "x: found an unknown key, accepted the keys "), std::string::npos) << error;
  }
}

TEST_P(ParameterTable, EachRowHasUnitAndMeaning) {
  // The first ending that fits counts.
  const std::vector<std::pair<std::string, std::string>> units{{"_rad_sqrt_s", "rad/sqrt(s)"},
                                                               {"_n_s_m", "N s/m"},
                                                               {"_n_m", "N/m"},
                                                               {"_rad_s", "rad/s"},
                                                               {"_hz_s", "Hz/s"},
                                                               {"_m_s", "m/s"},
                                                               {"_1_m", "1/m"},
                                                               {"_1_s", "1/s"},
                                                               {"_s", "s"},
                                                               {"_m", "m"},
                                                               {"_hz", "Hz"},
                                                               {"_rad", "rad"},
                                                               {"_nm", "Nm"},
                                                               {"_deg", "deg"},
                                                               {"_n", "N"},
                                                               {"_ticks", "ticks"},
                                                               {"_pixels", "pixels"}};
  for (const auto& row : rows_of({})) {
    EXPECT_GT(row.meaning.size(), 8U) << row.key;
    EXPECT_NE(row.meaning.back(), '.') << row.key;
    const auto known =
        std::find_if(units.begin(), units.end(), [&](const auto& each) { return row.key.ends_with(each.first); });
    if (row.is_number && known != units.end()) {
      EXPECT_EQ(row.unit, known->second) << row.key;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryComponent, ParameterTable, ::testing::ValuesIn(components_with_rows()),
                         [](const auto& made) { return made.param; });

}  // namespace
}  // namespace constrictor
