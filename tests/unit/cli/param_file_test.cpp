// Files of `param dump` and `param load`.
#include <gtest/gtest.h>

#include "cli/param_file.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

OwnedParameter parameter(const std::string& name, double value, double minimum, double maximum, bool whole = false) {
  OwnedParameter owned;
  owned.owner = name.substr(0, name.find('.'));
  set_text(owned.parameter.name, name);
  set_text(owned.parameter.unit, "Hz");
  set_text(owned.parameter.doc, "how often");
  owned.parameter.is_integer = whole;
  owned.parameter.minimum = minimum;
  owned.parameter.maximum = maximum;
  owned.parameter.default_value = owned.parameter.value = value;
  owned.parameter.changed_tick = owned.parameter.pending_tick = -1;
  return owned;
}

ParameterView view() {
  ParameterView view;
  for (const auto& each :
       {parameter("navigation.travel.speed_m_s", 0.7, 0.05, 2), parameter("navigation.grasp.steps", 3, 1, 9, true),
        parameter("control.wave.curvature_rate_1_ms", 0.1 + 0.2, 0, 5)})
    view.parameters[each.parameter.name] = each;
  return view;
}

bool is_fixed(const std::string& name) { return name == "control.joints.gain"; }

std::vector<ParameterValue> read(const std::string& text) {
  return read_parameter_file(text, "f.yaml", view(), is_fixed);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParameterFile, IsReadBackWithTheSameNumbers) {
  ParameterView changed = view();
  changed.parameters["navigation.travel.speed_m_s"].parameter.value = 1.0 / 3.0;
  changed.parameters["navigation.grasp.steps"].parameter.pending_value = 4;
  changed.parameters["navigation.grasp.steps"].parameter.pending_tick = 900;
  const std::string text = parameter_file(changed, "Parameters of a run", false);
  EXPECT_TRUE(text.starts_with("# Parameters of a run\n")) << text;
  const auto values = read(text);
  ASSERT_EQ(values.size(), 2u) << "what is in force already is left out: " << text;
  EXPECT_EQ(values[0].name, "navigation.grasp.steps");
  EXPECT_EQ(values[0].value, 4);
  EXPECT_EQ(values[1].name, "navigation.travel.speed_m_s");
  EXPECT_EQ(values[1].value, 1.0 / 3.0) << "bit for bit";
}

TEST(ParameterFile, KeepsNamesOfValues) {
  ParameterView named = view();
  OwnedParameter method = parameter("control.motion.travel.method", 1, 0, 2, true);
  set_text(method.parameter.choices, "undulation sidewinding rolling");
  named.parameters["control.motion.travel.method"] = method;
  const std::string text = parameter_file(named, "Parameters", false);
  EXPECT_NE(text.find("\ncontrol.motion.travel.method: sidewinding  # one of undulation, sidewinding, rolling; "),
            std::string::npos)
      << text;
  EXPECT_TRUE(read_parameter_file(text, "f.yaml", named, is_fixed).empty()) << "the value is in force already";
  const auto values = read_parameter_file("control.motion.travel.method: rolling\n", "f.yaml", named, is_fixed);
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(values[0].value, 2);
  EXPECT_EQ(values[0].text, "rolling");
  EXPECT_THROW(static_cast<void>(read_parameter_file("control.motion.travel.method: hop\n", "f.yaml", named, is_fixed)),
               ConfigurationError);
}

TEST(ParameterFile, OfChangesHasNothingElse) {
  ParameterView changed = view();
  changed.parameters["navigation.travel.speed_m_s"].parameter.changed_tick = 300;
  const std::string text = parameter_file(changed, "t", true);
  EXPECT_NE(text.find("navigation.travel.speed_m_s: 0.7"), std::string::npos) << text;
  EXPECT_EQ(text.find("grasp"), std::string::npos) << text;
}

TEST(ParameterFile, MayBeNestedLikeTheConfigurationOfAComponent) {
  const auto values = read("navigation:\n  travel: {speed_m_s: 0.9}\n  grasp.steps: 5\n");
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[0].name, "navigation.travel.speed_m_s");
  EXPECT_EQ(values[0].value, 0.9);
  EXPECT_EQ(values[1].value, 5);
}

TEST(ParameterFile, NamesEveryMistakeWithItsLine) {
  EXPECT_EQ(refusal("navigation.travel.speed_m_s: 7\n"
                    "navigation.grasp.steps: 2.5\n"
                    "navigation.travel.speeed_m_s: 1\n"
                    "control.joints.gain: 3\n"
                    "navigation.grasp.steps: 2\n"
                    "control: {wave: {curvature_rate_1_ms: fast}}\n"
                    "navigation.travel: [1, 2]\n"),
            "f.yaml:1: navigation.travel.speed_m_s: found 7, accepted 0.05 to 2 Hz\n"
            "f.yaml:2: navigation.grasp.steps: found 2.5, accepted whole, 1 to 9 Hz\n"
            "f.yaml:3: navigation.travel.speeed_m_s: found no such parameter, accepted those of `constrictor param "
            "list`, did you mean 'navigation.travel.speed_m_s'?\n"
            "f.yaml:4: control.joints.gain: cannot change while the run goes on; accepted in a configuration file, for "
            "the next run: `constrictor run --config control=FILE`\n"
            "f.yaml:5: navigation.grasp.steps: found twice, first in line 2, accepted once\n"
            "f.yaml:6: control.wave.curvature_rate_1_ms: found fast, accepted 0 to 5 Hz\n"
            "f.yaml:7: navigation.travel: found no such parameter, accepted those of `constrictor param list`, did you "
            "mean 'navigation.travel.speed_m_s'?");
  EXPECT_EQ(refusal("- 1\n"), "f.yaml:1: found no map, accepted lines as NAME: VALUE");
  EXPECT_TRUE(refusal("a: [\n").starts_with("f.yaml:")) << refusal("a: [\n");
  EXPECT_EQ(refusal("navigation.travel.speed_m_s: .inf\n"),
            "f.yaml:1: navigation.travel.speed_m_s: found .inf, accepted 0.05 to 2 Hz");
  EXPECT_TRUE(read("").empty());
}

TEST(ParameterFile, KnowsWhatIsInTheConfigurationOfAComponent) {
  for (const char* name : {"navigation.travel.speed_m_s", "navigation.travel"})
    EXPECT_TRUE(is_in_configuration(name)) << name;
  for (const char* name : {"navigation.travel.speed_m_s.x", "navigation", "nobody.travel", "../tools.x", ""})
    EXPECT_FALSE(is_in_configuration(name)) << name;
}

}  // namespace
}  // namespace constrictor::cli
