#include "cli/introspection/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "cli/scenario_command.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/task_names.hpp"
#include "constrictor/topics.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct Word {
  std::string text;
  std::string what;
};

/// The words that complete a value: fixed words and the output of a command. If both are empty, the shell offers files.
struct Values {
  std::string words;
  std::string command;
  [[nodiscard]] bool any() const { return !words.empty() || !command.empty(); }
};

struct OptionWord : Word {
  bool takes_value = false;
  Values values;
};

/// One subcommand, by its path: "topic echo".
struct Node {
  std::string path;
  std::vector<Word> subcommands;
  std::vector<OptionWord> options;
  Values values;  ///< of its positional arguments
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// The words of a comma-separated list. Blanks within a word become underscores: "line lost" becomes line_lost.
std::string typed(std::string list) {
  std::string words;
  for (std::size_t at = 0; at < list.size(); ++at) {
    if (list.compare(at, 2, ", ") == 0) ++at, words += ' ';
    else words += list[at] == ' ' ? '_' : list[at];
  }
  return words;
}

/// The different values of a column of the table of topics, in the order of its rows, each with this ending.
std::string words_of(std::string_view TopicInfo::*column, const char* ending = "") {
  std::vector<std::string> words;
  for (const auto& info : topics::kInfos) {
    const std::string word = std::string(info.*column) + ending;
    if (std::count(words.begin(), words.end(), word) == 0) words.push_back(word);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string names_command(const std::string& kind) { return "constrictor list " + kind + " --names 2>/dev/null"; }

/// Values of the positional arguments of a subcommand.
Values values_of_path(const std::string& path) {
  if (path == "param get" || path == "param set" || path == "param list")
    return {"", "constrictor param list --names 2>/dev/null"};
  if (path == "task start") return {typed(task_words()), ""};
  if (path == "pace") return {"lockstep 1x 2x", ""};
  if (path == "node info" || path == "host" || path == "swap" || path == "serve")
    return {words_of(&TopicInfo::writer), ""};
  // Other programs, which `constrictor` becomes: their subcommands are not among those of `app`.
  if (path == "camera") return {"show calibrate mount colours", ""};
  if (path == "conform") return {"plant camera perception control planner", ""};
  if (path == "run" || path == "check" || path == "evaluate" || path == "scenario show")
    return {"", names_command("scenarios")};
  if (path == "topic find") return {words_of(&TopicInfo::type), ""};
  if (path.rfind("topic ", 0) == 0 && path != "topic list") return {words_of(&TopicInfo::name), ""};
  return {};
}

/// Values of an option. An option name has the same meaning in all subcommands.
Values values_of_option(const std::string& name) {
  if (name == "type") return {words_of(&TopicInfo::type), ""};
  if (name == "event") return {typed(event_words()), ""};
  if (name == "direction") return {typed(direction_words()), ""};
  if (name.size() > 7 && name.compare(name.size() - 7, 7, "-colour") == 0) return {typed(colour_words()), ""};
  if (name == "pace") return {"lockstep realtime 2x", ""};
  if (name == "difficulty") return {fmt::format("{}", fmt::join(kDifficulties, " ")), ""};
  if (name == "goal") return {"any", ""};
  if (name == "manifest") return {"", names_command("manifests")};
  if (name == "robot") return {"", names_command("robots")};
  if (name == "group" || name == "component") return {words_of(&TopicInfo::writer), ""};
  if (name == "topic") return {words_of(&TopicInfo::name), ""};
  return {};
}

/// The words that one_of() accepts for this option: the validator shows them as {A,B} behind the type.
Values values_of_check(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto begin = type.rfind('{');
  const auto end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::string words = type.substr(begin + 1, end - begin - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return {words, ""};
}

/// Collects the options of an app and of its option groups, which CLI11 represents as subcommands without a name.
void collect_options(const CLI::App& app, Node& node) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() && !node.values.any()) node.values = values_of_check(*option);
    for (const auto& name : option->get_lnames()) {
      OptionWord word;
      word.text = "--" + name;
      word.what = first_line(option->get_description());
      word.takes_value = option->get_items_expected_max() > 0;
      word.values = values_of_option(name);
      if (word.what.starts_with("NAME=FILE")) word.values = {words_of(&TopicInfo::writer, "="), ""};
      if (!word.values.any()) word.values = values_of_check(*option);
      node.options.push_back(word);
    }
  }
  for (const CLI::App* group : app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); })) {
    if (group != &app) collect_options(*group, node);
  }
}

void collect(const CLI::App& app, const std::string& path, std::vector<Node>& nodes) {
  Node node{path, {}, {}, values_of_path(path)};
  const auto subs = app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
  for (const CLI::App* sub : subs) node.subcommands.push_back({sub->get_name(), first_line(sub->get_description())});
  collect_options(app, node);
  nodes.push_back(node);
  for (const CLI::App* sub : subs) collect(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), nodes);
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  return fmt::format("{}", fmt::join(words, between));
}

/// A word list for double quotes in bash. Only the command needs its dollar sign; nothing needs escaping.
std::string bash_words(const std::vector<std::string>& words, const Values& values) {
  std::string text = joined(words, " ");
  if (!values.words.empty()) text += " " + values.words;
  if (!values.command.empty()) text += " $(" + values.command + ")";
  return text;
}

/// The script for bash. zsh can also use it, by its bash-compatible completion; therefore it must not use a variable
/// `path`, which in zsh is another name of $PATH.
std::string bash_script(const std::string& name, const std::vector<Node>& nodes) {
  std::string cases;
  std::string valued;
  std::vector<std::string> known;
  for (const auto& node : nodes) {
    std::vector<std::string> words;
    for (const auto& sub : node.subcommands) words.push_back(sub.text);
    for (const auto& option : node.options) {
      words.push_back(option.text);
      if (option.takes_value)
        valued += fmt::format("    '{} {}') words=\"{}\"; value=1 ;;\n", node.path, option.text,
                              bash_words({}, option.values));
    }
    cases += fmt::format("    '{}') words=\"{}\" ;;\n", node.path, bash_words(words, node.values));
    if (!node.path.empty()) known.push_back("'" + node.path + "'");
  }
  return fmt::format(R"(# Completion of {0} for bash:  source <({0} completion bash)
_{0}() {{
  local node='' next i words='' value='' equals=''
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
  for ((i = 1; i < COMP_CWORD; i++)); do
    next="${{node:+$node }}${{COMP_WORDS[i]}}"
    case "$next" in {1}) node="$next" ;; esac
  done
  # bash makes three words of --option=value, and of NAME=FILE.
  if [ "$before" = '=' ]; then before="${{COMP_WORDS[COMP_CWORD-2]}}" equals=1; fi
  if [ "$current" = '=' ]; then current='' equals=1; fi
  # The value of an option: its words, or else a file name, which the shell completes.
  case "$node $before" in
{3}    *) value="$equals" ;;
  esac
  if [ -z "$value" ]; then
    case "$node" in
{2}    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  case "${{COMPREPLY[*]}}" in *=) compopt -o nospace 2>/dev/null ;; esac
}}
complete -o default -F _{0} {0}
)",
                     name, joined(known, "|"), cases, valued);
}

std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "'";
}

std::string fish_values(const Values& values) {
  return fish_quoted(values.command.empty()
                         ? values.words
                         : values.words + (values.words.empty() ? "" : " ") + "(" + values.command + ")");
}

std::string fish_script(const std::string& name, const std::vector<Node>& nodes) {
  std::vector<std::string> known;
  for (const auto& node : nodes) {
    if (!node.path.empty()) known.push_back("'" + node.path + "'");
  }
  // The path is the longest subcommand that the words before the cursor form; all other words are values.
  std::string script = fmt::format(R"(# Completion of {0} for fish:  {0} completion fish | source
function __{0}_at
  set -l path ''
  for word in (commandline -opc)[2..]
    set -l next (string trim -- "$path $word")
    if contains -- "$next" {1}
      set path "$next"
    end
  end
  test "$path" = "$argv"
end
)",
                                   name, joined(known, " "));
  for (const auto& node : nodes) {
    const std::string at = fmt::format("complete -c {0} -n '__{0}_at {1}'", name, node.path);
    for (const auto& sub : node.subcommands)
      script += fmt::format("{} -f -a {} -d {}\n", at, sub.text, fish_quoted(sub.what));
    for (const auto& option : node.options) {
      const bool file_follows = option.values.words.ends_with("=");  // NAME=FILE
      const std::string value = !option.takes_value ? ""
                                : option.values.any()
                                    ? (file_follows ? " -r -a " : " -x -a ") + fish_values(option.values)
                                    : " -r";
      script += fmt::format("{} -l {}{} -d {}\n", at, option.text.substr(2), value, fish_quoted(option.what));
    }
    if (node.values.any()) script += fmt::format("{} -f -a {}\n", at, fish_values(node.values));
  }
  return script;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  std::vector<Node> nodes;
  collect(app, "", nodes);
  const std::string name = "constrictor";
  if (shell == "fish") return fish_script(name, nodes);
  const std::string script = bash_script(name, nodes);
  return shell == "zsh" ? "(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }\nautoload -Uz +X "
                          "bashcompinit && bashcompinit\n" +
                              script
                        : script;
}

void add_completion(CLI::App& app, Action& action) {
  auto shell = std::make_shared<std::string>();
  auto* sub =
      app.add_subcommand("completion", "print a script that lets a shell complete subcommands, options and names");
  sub->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(one_of({"bash", "zsh", "fish"}));
  sub->footer(
      "EXAMPLES\n  source <(constrictor completion bash)\n  constrictor completion zsh > ~/.constrictor-completion && "
      ". ~/.constrictor-completion\n"
      "  constrictor completion fish | source\n\nEXIT STATUS\n  0 done; 64 wrong usage\n\nENVIRONMENT\n  none");
  sub->callback([&action, &app, shell] {
    action = [&app, shell] {
      fmt::print("{}", completion_script(app, *shell));
      return exit_status::kOk;
    };
  });
}

}  // namespace constrictor::cli
