// Every run-time parameter is what its configuration file says it is: the same key, the same field, the same bounds.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "configuration/configuration.hpp"
#include "control/control_parameters.hpp"
#include "guidance/guidance_parameters.hpp"
#include "navigation/navigation_parameters.hpp"
#include "perception/perception_parameters.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;

class NoWiring : public Wiring {
 public:
  const InputSlot* input(const TopicInfo&, bool) override { return nullptr; }
  const OutputSlot* output_slot(const TopicInfo&) override { return nullptr; }
  void request_end_of_run() override {}
};

/// The table of an owner whose configuration is `file`. Throws ConfigurationError.
template <class Config>
std::vector<msg::Parameter> table(Config config, const Topic<msg::ParameterList>& topic) {
  NoWiring wiring;
  Parameters parameters(wiring, topic);
  add_parameters(config, parameters);
  const msg::ParameterList list = parameters.list({});
  return {list.parameters, list.parameters + list.count};
}

std::vector<msg::Parameter> table_of(const std::string& owner, const fs::path& file) {
  if (owner == "navigation") return table(load_navigation_config(file), topics::kNavigationParameters);
  if (owner == "control") return table(load_control_config(file), topics::kControlParameters);
  if (owner == "perception") return table(perception::load_perception_config(file), topics::kPerceptionParameters);
  return table(guidance::load_guidance_config(file), topics::kGuidanceParameters);
}

class ParameterTable : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    default_file_ = fs::path(CONSTRICTOR_SOURCE_DIR) / "components" / GetParam() / (std::string(GetParam()) + ".yaml");
  }

  /// The default file with one value replaced. Empty keys are an error of the test.
  [[nodiscard]] fs::path with(const std::string& name, const std::string& value) const {
    YAML::Node root = YAML::LoadFile(default_file_.string());
    std::vector<YAML::Node> path{root};
    std::istringstream keys(name.substr(name.find('.') + 1));
    std::string last;
    for (std::string key; std::getline(keys, key, '.');) {
      if (!last.empty()) path.push_back(path.back()[last]);
      last = key;
    }
    EXPECT_TRUE(path.back()[last].IsScalar()) << name << " is no key of " << default_file_;
    path.back()[last] = value;
    const fs::path file = dir_ / "changed.yaml";
    std::ofstream(file) << root;
    return file;
  }
  [[nodiscard]] bool accepts(const std::string& name, const std::string& value) const {
    try {
      static_cast<void>(table_of(GetParam(), with(name, value)));
      return true;
    } catch (const ConfigurationError&) {
      return false;
    }
  }
  static std::string text(const msg::Parameter& p, double value) {
    std::ostringstream stream;
    stream.precision(17);
    if (p.is_integer) stream << static_cast<long>(value);
    else stream << value;
    return stream.str();
  }

  const testing::TemporaryFolder folder_;
  const fs::path dir_ = folder_.path();
  fs::path default_file_;
};

TEST_P(ParameterTable, SetsTheFieldThatItsKeyOfTheFileSets) {
  const auto before = table_of(GetParam(), default_file_);
  for (std::size_t i = 0; i < before.size(); ++i) {
    // Somewhere within the bounds, where the default is not.
    const double value = before[i].default_value == before[i].minimum ? before[i].maximum : before[i].minimum;
    const auto after = table_of(GetParam(), with(before[i].name, text(before[i], value)));
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_EQ(after[k].default_value, k == i ? value : before[k].default_value) << after[k].name << " when " << before[i].name << " is set";
    }
  }
}

TEST_P(ParameterTable, HasTheBoundsThatTheFileHas) {
  for (const auto& p : table_of(GetParam(), default_file_)) {
    const double step = p.is_integer ? 1.0 : 1e-6 * (p.maximum - p.minimum);
    EXPECT_TRUE(accepts(p.name, text(p, p.minimum))) << p.name;
    EXPECT_TRUE(accepts(p.name, text(p, p.maximum))) << p.name;
    EXPECT_FALSE(accepts(p.name, text(p, p.minimum - step))) << p.name << " at " << p.minimum;
    EXPECT_FALSE(accepts(p.name, text(p, p.maximum + step))) << p.name << " at " << p.maximum;
  }
}

TEST_P(ParameterTable, SaysUnitAndMeaning) {
  const std::vector<std::pair<std::string, std::string>> units{{"_hz", "Hz"}, {"_rad", "rad"}, {"_nm", "Nm"}, {"_rad_s", "rad/s"},
                                                               {"_hz_s", "Hz/s"}, {"_m_s", "m/s"}, {"_1_m", "1/m"}, {"_deg", "deg"}};
  for (const auto& p : table_of(GetParam(), default_file_)) {
    EXPECT_GT(std::string(p.doc).size(), 8u) << p.name;
    const std::string name = p.name;
    for (const auto& [ending, unit] : units) {
      const bool ends = name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
      if (ends) { EXPECT_EQ(p.unit, unit) << name; }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryOwner, ParameterTable, ::testing::Values("navigation", "control", "perception", "guidance"),
                         [](const auto& made) { return std::string(made.param); });

}  // namespace
}  // namespace constrictor
