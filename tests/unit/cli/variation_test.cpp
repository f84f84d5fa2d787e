// What `constrictor evaluate` varies: seeds, and values of files.
#include "cli/evaluate/variation.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "cli/usage.hpp"
#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using testing::TemporaryFolder;

TEST(Seeds, RangesAndListsNameEachSeedOnce) {
  EXPECT_EQ(parse_seeds("7"), (std::vector<std::uint64_t>{7}));
  EXPECT_EQ(parse_seeds("3..5,1,4..6"), (std::vector<std::uint64_t>{3, 4, 5, 1, 6}));
  EXPECT_EQ(parse_seeds("18446744073709551615"), (std::vector<std::uint64_t>{18446744073709551615u}));
  EXPECT_EQ(parse_seeds("18446744073709551614..18446744073709551615").size(), 2u);
  for (const char* wrong :
       {"", "a", "1..", "..3", "5..1", "1,,2", "-1", "1.5", "1..3x", "0..18446744073709551615", "18446744073709551616"})
    EXPECT_THROW(static_cast<void>(parse_seeds(wrong)), UsageError) << wrong;
}

TEST(Variations, NameTheirFileTheScenarioByDefault) {
  const Variation plain = parse_variation("noise.camera_sd=0,0.02");
  EXPECT_EQ(plain.file, "scenario");
  EXPECT_EQ(plain.key, "noise.camera_sd");
  EXPECT_EQ(plain.values, (std::vector<std::string>{"0", "0.02"}));
  const Variation list = parse_variation("navigation:a.b=[1, 2],{c: [3, 4]}");
  EXPECT_EQ(list.file, "navigation");
  EXPECT_EQ(list.values, (std::vector<std::string>{"[1, 2]", "{c: [3, 4]}"}));
  EXPECT_EQ(parse_variation("objects.0.colour=a:b").file, "scenario") << "a colon in the value names no file";
  for (const char* wrong : {"", "noise", "=1", "noise=", "noise=1,,2", ":key=1", "robot:=1"})
    EXPECT_THROW(static_cast<void>(parse_variation(wrong)), UsageError) << wrong;
}

/// What make_variants() or parse_variation() says about wrong usage; empty: nothing is wrong.
std::string usage_error(const std::vector<std::string>& texts) {
  try {
    std::vector<Variation> variations;
    for (const auto& text : texts) variations.push_back(parse_variation(text));
    static_cast<void>(make_variants(variations));
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST(Variations, HaveEachValueOnce) {
  for (const char* wrong : {"robot:a.b=0.5,0.5", "robot:a.b=0.5,1,0.50", "robot:a.b=x, x", "robot:a.b=[1, 2],[1, 2]"})
    EXPECT_NE(usage_error({wrong}).find("--vary robot:a.b: found the value "), std::string::npos) << wrong;
  EXPECT_NE(usage_error({"a=0.5,0.5"}).find("found the value 0.5 twice, accepted each value once"), std::string::npos);
  EXPECT_EQ(usage_error({"a=0.5,0.51,x,X,[1],[1.0]"}), "");
}

TEST(Variants, HaveEachKeyOnce) {
  const std::string same = usage_error({"a.b=1", "c=3", "a.b=2"});
  EXPECT_NE(same.find("--vary a.b: found also --vary a.b, which it would overwrite"), std::string::npos) << same;
  EXPECT_NE(same.find("in one --vary, such as a.b=1,2"), std::string::npos) << same;
  EXPECT_NE(usage_error({"scenario:a=1", "a=2"}).find("--vary a: found also"), std::string::npos);
  EXPECT_NE(usage_error({"a.b=1", "a={b: 2}"}).find("--vary a: found also --vary a.b"), std::string::npos);
  EXPECT_EQ(usage_error({"a={b: 2}", "a.b=1"}), "") << "the second changes a part of the first";
  EXPECT_EQ(usage_error({"a.b=1", "a.bc=1", "robot:a.b=1"}), "");
}

TEST(Variants, AreAllCombinationsInFoldersOfTheirOwn) {
  const auto variants = make_variants({parse_variation("a=1,2"), parse_variation("robot:b/c=x,x y")});
  ASSERT_EQ(variants.size(), 4u);
  EXPECT_EQ(variants[1].name, "a=1, robot:b/c=x y");
  std::set<std::string> folders;
  for (const auto& variant : variants) {
    folders.insert(variant.folder);
    EXPECT_EQ(variant.folder.find_first_of("/ :"), std::string::npos) << variant.folder;
  }
  EXPECT_EQ(folders.size(), 4u);
  EXPECT_EQ(make_variants({parse_variation("a=x y,x_y")})[1].folder, "a=x_y_2")
      << "two names, one spelling as a folder";
  EXPECT_EQ(make_variants({}).size(), 1u);
}

TEST(Variants, ChangeOneValueOfACopyOfTheFile) {
  const TemporaryFolder folder;
  RunOptions base;
  base.scenario = "short";
  const auto options = [&](const std::string& vary) {
    return options_of(make_variants({parse_variation(vary)}).front(), base, folder.path());
  };
  const auto text = [](const std::filesystem::path& file) {
    std::ifstream stream(file);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const RunOptions noisy = options("noise.camera_sd=0.5");
  EXPECT_EQ(std::filesystem::path(noisy.scenario).filename(), "short.yaml") << "the run keeps the scenario's name";
  EXPECT_EQ(Configuration::load(noisy.scenario).one_line("noise"), "{sensors: true, camera_sd: 0.5}");
  const std::string original = find_file("short", kScenarios).string();
  EXPECT_EQ(Configuration::load(noisy.scenario).one_line("mission"), Configuration::load(original).one_line("mission"));
  EXPECT_EQ(Configuration::load(noisy.scenario).one_line("line"), Configuration::load(original).one_line("line"));
  EXPECT_NE(text(options("objects.0.mass_kg=0.7").scenario).find("mass_kg: 0.7"), std::string::npos);
  EXPECT_TRUE(options("navigation:travel.speed_m_s=0.8").scenario == "short");
  EXPECT_TRUE(options("navigation:travel.speed_m_s=0.8").config_files.front().starts_with("navigation="));
  for (const char* wrong : {"objects.7.mass_kg=1", "objects.x.mass_kg=1", "name.x=1", "nobody:a=1", "noise=[1"})
    EXPECT_THROW(static_cast<void>(options(wrong)), ConfigurationError) << wrong;
}

}  // namespace
}  // namespace constrictor::cli
