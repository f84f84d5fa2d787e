#include "cli/usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "configuration/closest_name.hpp"
#include "cyclone/run_token.hpp"

namespace constrictor::cli {
namespace {

/// The whole text as a number; empty if the text is not a number, or if the number is too large for its type.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The subcommand that the words of the command line name.
const CLI::App& chosen_subcommand(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : chosen_subcommand(*chosen.back());
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* each) { return !each->get_name().empty(); })) {
    names.push_back(sub->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  // A group of options is a subcommand without a name.
  for (const CLI::App* group : app.get_subcommands([](const CLI::App* each) { return each->get_name().empty(); })) {
    for (auto& name : option_names(*group)) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

CLI::Validator whole_number(std::uint64_t min, std::uint64_t max) {
  return {[min, max](std::string& text) {
            const auto value = parse<std::uint64_t>(text);
            if (value && *value >= min && *value <= max) return std::string{};
            return fmt::format("found '{}', accepted a whole number from {} to {}", text, min, max);
          },
          ""};
}

CLI::Validator number(double min, double max, const std::string& unit) {
  return {[=](std::string& text) {
            const auto value = parse<double>(text);
            if (value && std::isfinite(*value) && *value >= min && *value <= max) return std::string{};
            return fmt::format("found '{}', accepted a number from {:g} to {:g}{}{}", text, min, max,
                               unit.empty() ? "" : " ", unit);
          },
          ""};
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string accepted = fmt::format("{}", fmt::join(words, ", "));
  std::string shown_in_help = fmt::format("{{{}}}", fmt::join(words, ","));
  return {[words = std::move(words), accepted](std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end()) return std::string{};
            return fmt::format("found '{}', accepted {}{}", text, accepted, did_you_mean(text, words));
          },
          std::move(shown_in_help)};
}

void add_run_option(CLI::App& app, std::optional<std::uint32_t>& domain) {
  app.add_option("--run,--domain", domain,
                 "DDS domain of the run, which may be on another host (default: the only run on this host)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  add_token_option(app);
}

void add_token_option(CLI::App& app) {
  app.add_option_function<std::string>(
      "--token-file",
      [](const std::string& file) {
        static_cast<void>(read_token_file(file));
        ::setenv("CONSTRICTOR_TOKEN_FILE", file.c_str(), 1);
      },
      "file with the token of a run that was not started on this host (default: $CONSTRICTOR_TOKEN_FILE)");
}

std::string help_footer(const std::string& about, std::initializer_list<const char*> examples,
                        const std::string& exit_status, const std::string& environment) {
  std::string text = about + (about.empty() ? "" : "\n\n") + "EXAMPLES\n";
  for (const char* example : examples) text += fmt::format("  {}\n", example);
  return text + "\nEXIT STATUS\n  " + exit_status + "\n\nENVIRONMENT\n  " + environment;
}

std::string explain_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& sub = chosen_subcommand(app);
  std::string help = "constrictor";
  for (const CLI::App* at = &sub; at->get_parent(); at = at->get_parent()) help.insert(11, " " + at->get_name());
  help += " --help";
  const auto rest = app.remaining(true);
  const bool words_left =
      dynamic_cast<const CLI::ExtrasError*>(&error) || dynamic_cast<const CLI::RequiredError*>(&error);
  if (!words_left || rest.empty()) return fmt::format("{} (see {})", error.what(), help);
  const bool is_option = rest.front().starts_with("-");
  const std::string word = is_option ? rest.front().substr(0, rest.front().find('=')) : rest.front();
  const auto accepted = is_option ? option_names(sub) : subcommand_names(sub);
  if (accepted.empty()) return fmt::format("unexpected argument '{}' (see {})", word, help);
  return fmt::format("no {} '{}'{} (see {})", is_option ? "option" : "subcommand", word, did_you_mean(word, accepted),
                     help);
}

}  // namespace constrictor::cli
