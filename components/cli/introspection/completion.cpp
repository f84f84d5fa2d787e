#include "cli/introspection/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

/// One subcommand, by its path: "topic echo".
struct Node {
  std::string path;
  std::vector<std::pair<std::string, std::string>> words;  ///< what may follow, and what it is for
  std::vector<std::string> with_value;                     ///< options that a file or value follows
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void collect(const CLI::App& app, const std::string& path, std::vector<Node>& nodes) {
  Node node{path, {}, {}};
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_name().empty()) node.words.emplace_back(sub->get_name(), first_line(sub->get_description()));
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) {
      node.words.emplace_back("--" + name, first_line(option->get_description()));
      if (option->get_items_expected_max() > 0) node.with_value.push_back("--" + name);
    }
  }
  nodes.push_back(node);
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_name().empty()) collect(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), nodes);
  }
}

std::string words_of(const Node& node) {
  std::string words;
  for (const auto& word : node.words) words += (words.empty() ? "" : " ") + word.first;
  return words;
}

/// Subcommands after which the names of the run's own parameters may follow.
const std::vector<std::string> kAfterThemParameters{"param get", "param set", "param list"};

/// Bash, and zsh by its bash-compatible completion.
std::string bash_script(const std::string& name, const std::vector<Node>& nodes) {
  std::string cases;
  std::string known;
  std::string valued;
  for (const auto& node : nodes) {
    const bool parameters = std::count(kAfterThemParameters.begin(), kAfterThemParameters.end(), node.path) > 0;
    cases += parameters ? fmt::format("    '{}') words=\"{} $({} param list --names 2>/dev/null)\" ;;\n", node.path, words_of(node), name)
                        : fmt::format("    '{}') words='{}' ;;\n", node.path, words_of(node));
    for (const auto& option : node.with_value) valued += fmt::format("    '{} {}') COMPREPLY=(); return ;;\n", node.path, option);
    if (!node.path.empty()) known += fmt::format("{}'{}'", known.empty() ? "" : "|", node.path);
  }
  return fmt::format(R"(# Completion of {0} for bash:  source <({0} completion bash)
_{0}() {{
  local path='' next i words current="${{COMP_WORDS[COMP_CWORD]}}"
  for ((i = 1; i < COMP_CWORD; i++)); do
    next="${{path:+$path }}${{COMP_WORDS[i]}}"
    case "$next" in {1}) path="$next" ;; esac
  done
  # A value follows, usually a file: leave that to the shell.
  case "$path ${{COMP_WORDS[COMP_CWORD-1]}}" in
{3}  esac
  case "$path" in
{2}  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _{0} {0}
)", name, known, cases, valued);
}

std::string fish_script(const std::string& name, const std::vector<Node>& nodes) {
  std::string script = fmt::format("# Completion of {0} for fish:  {0} completion fish | source\n", name);
  script += fmt::format("function __{0}_at\n  set -l path\n  for word in (commandline -opc)[2..]\n    string match -q -- '-*' $word; or set -a path $word\n  end\n"
                        "  test \"$path\" = \"$argv\"; or string match -q -- \"$argv *\" \"$path\"; and test -n \"$argv\"\nend\n", name);
  for (const auto& node : nodes) {
    for (const auto& [word, what] : node.words) {
      std::string text;
      for (const char c : what) text += c == '\'' ? std::string("\\'") : std::string(1, c);
      const bool option = word.rfind("--", 0) == 0;
      script += fmt::format("complete -c {0} -n '__{0}_at {1}' {2} {3} -d '{4}'\n", name, node.path, option ? "-l" : "-f -a",
                            option ? word.substr(2) : word, text);
    }
    if (std::count(kAfterThemParameters.begin(), kAfterThemParameters.end(), node.path) > 0) {
      script += fmt::format("complete -c {0} -n '__{0}_at {1}' -f -a '({0} param list --names 2>/dev/null)'\n", name, node.path);
    }
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
  return shell == "zsh" ? "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n" + script : script;
}

void add_completion(CLI::App& app, std::function<int()>& action) {
  auto shell = std::make_shared<std::string>();
  auto* sub = app.add_subcommand("completion", "print a script by which a shell completes this command's words");
  sub->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  sub->footer("EXAMPLES\n  source <(constrictor completion bash)\n  constrictor completion zsh > ~/.constrictor-completion && . ~/.constrictor-completion\n"
              "  constrictor completion fish | source\n\nEXIT STATUS\n  0 done; 64 wrong usage");
  sub->callback([&action, &app, shell] {
    action = [&app, shell] {
      fmt::print("{}", completion_script(app, *shell));
      return exit_status::kOk;
    };
  });
}

}  // namespace constrictor::cli
