// Taught colours are judged by perception itself: it must recognise them in a picture, and nothing else.
#include "camera_setup/colours.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgproc.hpp>

#include "perception/colour_classifier.hpp"
#include "perception/perception_config.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::camera_setup {
namespace {

using camera_setup::ColourSample;
using camera_setup::teach_colours;

/// Colours that the usual hues of perception do not fit: a turquoise "blue", an orange "red", a lime "green".
const std::map<std::string, cv::Scalar> kPaints = {  // BGR
    {"blue", {150, 140, 30}},
    {"red", {30, 90, 190}},
    {"green", {40, 170, 120}},
    {"ground", {128, 134, 131}}};

cv::Mat patch(const std::string& name, std::uint64_t seed) {
  cv::Mat picture(40, 40, CV_8UC3, kPaints.at(name));
  cv::Mat noise(40, 40, CV_16SC3), noisy;
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0, 4);
  cv::add(picture, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

std::map<std::string, ColourSample> samples() {
  std::map<std::string, ColourSample> found;
  for (const auto& [name, paint] : kPaints) found[name].add(patch(name, 1), {5, 5, 30, 30});
  return found;
}

TEST(TaughtColours, AreRecognisedByPerceptionAndTheGroundIsNot) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "perception.yaml";
  const auto result = teach_colours(samples());
  std::ofstream(file) << result.yaml;
  EXPECT_TRUE(result.warnings.empty());
  const perception::ColourClassifier taught(load_parameters<perception::PerceptionConfig>(file));
  const perception::ColourClassifier usual(load_parameters<perception::PerceptionConfig>({}));
  const auto share = [](const perception::ColourClassifier& classifier, const std::string& name, std::uint8_t colour) {
    cv::Mat rgb;
    cv::cvtColor(patch(name, 2), rgb, cv::COLOR_BGR2RGB);
    perception::Labels labels;
    classifier.classify(rgb, labels);
    return static_cast<double>(cv::countNonZero(labels.image == colour)) / static_cast<double>(labels.image.total());
  };
  EXPECT_GT(share(taught, "blue", msg::kColourBlue), 0.95);
  EXPECT_GT(share(taught, "red", msg::kColourRed), 0.95);
  EXPECT_GT(share(taught, "green", msg::kColourGreen), 0.95);
  EXPECT_GT(share(taught, "ground", msg::kColourUnknown), 0.95);
  EXPECT_LT(share(usual, "blue", msg::kColourBlue), 0.5) << "the usual hues must not do";
}

TEST(TaughtColours, AHueAroundRedIsNoProblem) {
  std::map<std::string, ColourSample> found;
  cv::Mat picture(10, 10, CV_8UC3, cv::Scalar(40, 20, 200));  // hue 353
  picture.rowRange(0, 5).setTo(cv::Scalar(20, 40, 200));      // hue 7
  found["red"].add(picture, {0, 0, 10, 10});
  const auto seen = found["red"].statistics();
  EXPECT_LT(std::min(seen.hue_deg, 360.0 - seen.hue_deg), 2.0);
  EXPECT_NEAR(seen.spread_deg, 6.7, 1.0);
  EXPECT_NE(teach_colours(found).yaml.find("red: {from_deg: 34"), std::string::npos) << teach_colours(found).yaml;
}

std::string refusal(const std::map<std::string, ColourSample>& samples) {
  try {
    static_cast<void>(teach_colours(samples));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(TaughtColours, RefusesWhatCannotBeToldApart) {
  auto found = samples();
  found["yellow"].add(patch("green", 3), {0, 0, 20, 20});
  EXPECT_THROW(static_cast<void>(teach_colours(found)), std::invalid_argument);
  std::map<std::string, ColourSample> pale;
  pale["blue"].add(patch("ground", 1), {0, 0, 20, 20});
  pale["ground"].add(patch("ground", 2), {0, 0, 20, 20});
  EXPECT_THROW(static_cast<void>(teach_colours(pale)), std::invalid_argument);
  pale["blue"] = {};
  pale["blue"].add(cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(128)), {0, 0, 20, 20});
  pale["ground"] = {};
  pale["ground"].add(cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(128)), {0, 0, 20, 20});
  EXPECT_NE(refusal(pale).find("blue: found chroma 0.000"), std::string::npos) << refusal(pale);
  pale.erase("ground");
  EXPECT_NE(refusal(pale).find("the box shows grey"), std::string::npos) << "also without a sample of the ground";
  cv::Mat two(20, 20, CV_8UC3, kPaints.at("blue"));
  two.rowRange(0, 10).setTo(kPaints.at("red"));
  std::map<std::string, ColourSample> mixed;
  mixed["blue"].add(two, {0, 0, 20, 20});
  EXPECT_NE(refusal(mixed).find("several colours"), std::string::npos) << refusal(mixed);
  std::map<std::string, ColourSample> none;
  none["ground"].add(patch("ground", 2), {0, 0, 20, 20});
  EXPECT_THROW(static_cast<void>(teach_colours(none)), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor::camera_setup
