#include "cli/usage.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>

#include "cli/subcommands.hpp"
#include "configuration/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

/// A command line with the same kinds of options as that of main.cpp.
class CommandLineTest : public ::testing::Test {
 protected:
  CommandLineTest() {
    app_.require_subcommand(1);
    auto* run = app_.add_subcommand("run");
    run->add_option("--seed", seed_)->check(whole_number());
    run->add_option("--max-sim-time", limit_s_)->check(number(0.0, 1e6, "s"));
    run->add_option("--domain", domain_)->check(whole_number(0, 229));
    run->add_option("--file", path_)->check(existing_file());
    run->add_option("--folder", path_)->check(existing_folder());
    run->add_option("--either", path_)->check(existing_path());
    auto* topic = app_.add_subcommand("topic");
    topic->require_subcommand(1);
    topic->add_subcommand("echo")->add_flag("--json");
  }
  /// The error text for a command line, or the empty string if it is correct.
  std::string error(std::vector<std::string> words) {
    std::reverse(words.begin(), words.end());
    try {
      app_.parse(words);
    } catch (const CLI::ParseError& error) {
      return explain_parse_error(app_, error);
    }
    return "";
  }

  CLI::App app_{"test", "constrictor"};
  std::uint64_t seed_ = 0;
  std::uint64_t domain_ = 0;
  double limit_s_ = 0.0;
  std::string path_;
};

TEST_F(CommandLineTest, AcceptsTheLargestSeedAndNoLargerOne) {
  EXPECT_EQ(error({"run", "--seed", "18446744073709551615"}), "");
  EXPECT_EQ(seed_, 18446744073709551615u);
  for (const std::string seed : {"18446744073709551616", "-1", "+1", "1.5", "1e3", "0x10", " 1", "seven"}) {
    EXPECT_NE(error({"run", "--seed=" + seed}).find("accepted a whole number from 0 to 18446744073709551615"),
              std::string::npos)
        << seed << ": " << error({"run", "--seed=" + seed});
  }
  EXPECT_NE(error({"run", "--seed="}).find("--seed: 1 required"), std::string::npos);
}

TEST_F(CommandLineTest, AcceptsOnlyFiniteNumbersWithinBounds) {
  EXPECT_EQ(error({"run", "--max-sim-time", "1e6"}), "");
  EXPECT_EQ(limit_s_, 1e6);
  for (const std::string limit : {"nan", "inf", "1000001", "-0.1", "ten", "10s"}) {
    EXPECT_NE(error({"run", "--max-sim-time=" + limit}).find("accepted a number from 0 to 1e+06 s"), std::string::npos)
        << limit;
  }
  EXPECT_NE(error({"run", "--domain", "230"}).find("accepted a whole number from 0 to 229"), std::string::npos);
}

TEST_F(CommandLineTest, AcceptsOnlyPathsThatExist) {
  const TemporaryFolder folder("usage");
  const std::string here = folder.path().string();
  const std::string file = here + "/file";
  std::ofstream(file) << "text";
  std::filesystem::create_symlink("circle", folder.path() / "circle");  // a symbolic link to itself
  EXPECT_EQ(error({"run", "--file", file, "--folder", here, "--either", file}), "");
  EXPECT_EQ(error({"run", "--either", here}), "");
  const std::string help = " (see constrictor run --help)";
  EXPECT_EQ(error({"run", "--file", "nofile"}), "--file: found no file 'nofile', accepted one that exists" + help);
  EXPECT_EQ(error({"run", "--folder", "none"}), "--folder: found no folder 'none', accepted one that exists" + help);
  EXPECT_EQ(error({"run", "--either", here + "/circle"}),
            "--either: found no file or folder '" + here + "/circle', accepted one that exists" + help);
  EXPECT_EQ(error({"run", "--file", here}), "--file: found the folder '" + here + "', accepted a file" + help);
  EXPECT_EQ(error({"run", "--folder", file}), "--folder: found the file '" + file + "', accepted a folder" + help);
}

TEST_F(CommandLineTest, NamesTheClosestSubcommandOrOption) {
  EXPECT_EQ(error({"rnu"}), "no subcommand 'rnu', did you mean 'run'? (see constrictor --help)");
  EXPECT_EQ(error({"topic", "ecko"}), "no subcommand 'ecko', did you mean 'echo'? (see constrictor topic --help)");
  EXPECT_EQ(error({"run", "--sead", "3"}), "no option '--sead', did you mean '--seed'? (see constrictor run --help)");
  EXPECT_EQ(error({"run", "--sead=3"}), "no option '--sead', did you mean '--seed'? (see constrictor run --help)");
  EXPECT_EQ(error({"run", "--quite-different"}), "no option '--quite-different' (see constrictor run --help)");
  app_.name("/usr/bin/constrictor");  // as CLI11 takes it from argv
  EXPECT_EQ(error({"run", "--quite-different"}), "no option '--quite-different' (see constrictor run --help)");
  app_.name("constrictor");
  EXPECT_EQ(error({"run", "elsewhere"}), "unexpected argument 'elsewhere' (see constrictor run --help)");
}

TEST(ParamHelp, ExplainsTheNameOfAParameterByItsKey) {
  CLI::App app;
  Action action;
  add_param(app, action);
  const std::string footer = app.get_subcommand("param")->get_footer();
  EXPECT_NE(footer.find("navigation.travel.speed_m_s is `travel: speed_m_s:` in navigation.yaml"), std::string::npos)
      << footer;
}

}  // namespace
}  // namespace constrictor::cli
