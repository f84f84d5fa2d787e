// The completion scripts of `constrictor completion`, called as each shell calls them.
#include <sstream>

#include "integration/introspection_fixture.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

/// Asks bash, zsh and fish which words they offer for a command line. The last word of the line is the one that the
/// user is typing.
class Completion : public Introspection {
 protected:
  using Words = std::vector<std::string>;

  /// The words that a shell offers for each of the lines: one string per line, with blanks around each word.
  [[nodiscard]] Words offers(const std::string& shell, const std::vector<Words>& lines) const {
    Process script({program("constrictor"), "completion", shell});
    EXPECT_EQ(script.wait(20s), 0) << script.errors();
    write("constrictor." + shell, script.output());
    std::string text = shell == "zsh" ? "autoload -Uz compinit && compinit -u -D\n" : "";
    text += "source " + (dir_ / ("constrictor." + shell)).string() + "\n";
    if (shell != "fish") {
      // The function `offer` calls the completion function as the shell does. zsh uses its bash-compatible completion;
      // it removes the words that do not begin with the typed text only afterwards, which this test does not see.
      text += "offer() {\n" + std::string(shell == "zsh" ? "emulate -L sh\n" : "") +
              "COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _constrictor; echo \"\" ${COMPREPLY[@]} \"\"\n}\n";
    }
    for (const auto& words : lines) {
      if (shell == "fish") {
        std::string line = "constrictor";
        for (const auto& word : words) line += " " + word;
        text += "echo '' (complete -C '" + line + "' | string replace -r '\\t.*' '') ''\n";
      } else {
        text += "offer constrictor";
        for (const auto& word : words) text += " '" + word + "'";
        text += "\n";
      }
    }
    write("offer." + shell, text);
    // The script calls `constrictor list` for some words, so the program must be in the PATH.
    auto environment = environment_;
    environment["PATH"] = std::filesystem::path(program("constrictor")).parent_path().string() + ":/usr/bin:/bin";
    Process process({"/usr/bin/" + shell, (dir_ / ("offer." + shell)).string()}, environment);
    EXPECT_EQ(process.wait(30s), 0) << process.errors();
    Words offered;
    std::istringstream output(process.output());
    for (std::string line; std::getline(output, line);) offered.push_back(line);
    return offered;
  }
};

TEST_F(Completion, EveryShellOffersOnlyTheWordsThatTheSubcommandAccepts) {
  struct Case {
    Words typed;
    std::string offered;
    std::string not_offered;
  };
  const std::vector<Case> cases = {{{""}, "teleop", "echo"},
                                   {{"te"}, "teleop", "topic"},
                                   {{"topic", ""}, "echo", "teleop"},
                                   {{"topic", "echo", ""}, "joint_state", "hz"},
                                   {{"topic", "echo", "--ti"}, "--timeout", "--count"},
                                   {{"topic", "find", ""}, "JointState", "joint_state"},
                                   {{"topic", "pub", "joint_state", "--type", "J"}, "JointState", "CameraImage"},
                                   {{"task", "wait", "--"}, "--event", "--line-colour"},
                                   {{"task", "wait", "--"}, "--end", "--path"},
                                   {{"task", "wait", "--event", ""}, "line_lost", "--timeout"},
                                   {{"task", "start", ""}, "follow_line", "wait"},
                                   {{"task", "start", "rotate", "--"}, "--direction", "--event"},
                                   {{"task", "start", "follow_line", "--line-colour", "b"}, "blue", "backwards"},
                                   {{"completion", ""}, "fish", "list"},
                                   {{"list", ""}, "robots", "fish"},
                                   {{"run", ""}, "case_study", "fish"},
                                   {{"check", "--robot", ""}, "serpens", "--seed"},
                                   {{"evaluate", ""}, "case_study", "fish"},
                                   {{"scenario", ""}, "random", "case_study"},
                                   {{"scenario", "show", "w"}, "wide", "random"},
                                   {{"scenario", "random", "--difficulty", ""}, "middle", "--seed"},
                                   {{"robot", ""}, "export", "list"},
                                   {{"robot", "export", "--robot", ""}, "serpens", "--mjcf"},
                                   {{"node", "info", "n"}, "navigation", "list"},
                                   {{"swap", "c"}, "camera", "case_study"},
                                   {{"serve", "c"}, "camera", "case_study"},
                                   {{"log", "--component", ""}, "navigation", "--since"},
                                   {{"log", "--level", ""}, "warning", "--since"},
                                   {{"replay", "--component", ""}, "navigation", "--topic"},
                                   {{"replay", "--topic", "joint_s"}, "joint_state", "--topic"},
                                   {{"record", "--topic", "joint_s"}, "joint_state", "--images"},
                                   {{"run", "--config", "n"}, "navigation=", "navigation"},
                                   {{"run", "--images", ""}, "recompute", "case_study"},
                                   {{"figure", "--format", ""}, "pdf", "--size"},
                                   {{"servo", "torque", "o"}, "off", "zero"},
                                   {{"camera", ""}, "calibrate", "plant"},
                                   {{"conform", ""}, "planner", "mount"}};
  std::vector<Words> lines;
  for (const auto& c : cases) lines.push_back(c.typed);
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const Words offered = offers(shell, lines);
    ASSERT_EQ(offered.size(), cases.size()) << shell;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      EXPECT_NE(offered[i].find(" " + cases[i].offered + " "), std::string::npos)
          << shell << " " << cases[i].offered << ": " << offered[i];
      if (shell == "zsh" && !cases[i].not_offered.starts_with(cases[i].typed.back())) continue;
      EXPECT_EQ(offered[i].find(" " + cases[i].not_offered + " "), std::string::npos)
          << shell << " " << cases[i].not_offered << ": " << offered[i];
    }
  }
}

TEST_F(Completion, BashCompletesWhatFollowsAnEqualsSign) {
  const Words offered = offers("bash", {{"check", "--manifest", "=", "man"},
                                        {"check", "--manifest", "="},
                                        {"run", "--config", "navigation", "="},
                                        {"run", "--config", "navigation", "=", "c"}});
  ASSERT_EQ(offered.size(), 4u);
  EXPECT_EQ(offered[0], " manual ");
  EXPECT_NE(offered[1].find(" manual "), std::string::npos) << offered[1];
  EXPECT_EQ(offered[2], " ") << "then bash offers files";
  EXPECT_EQ(offered[3], " ");
}

}  // namespace
}  // namespace constrictor::testing
