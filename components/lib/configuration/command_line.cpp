#include "configuration/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "configuration/closest_name.hpp"

namespace constrictor {
namespace {

/// The whole text as a number; empty if the text is not a number, or if the number is too large for its type.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Accepts paths of files, of folders, or of both.
CLI::Validator existing(const char* shown_in_help, bool files, bool folders) {
  const std::string accepted = files && folders ? "file or folder" : files ? "file" : "folder";
  return {[=](std::string& text) {
            std::error_code unreachable;  // for example because symbolic links form a loop
            const auto status = std::filesystem::status(text, unreachable);
            if (!std::filesystem::exists(status))
              return fmt::format("found no {} '{}', accepted one that exists", accepted, text);
            const bool folder = std::filesystem::is_directory(status);
            if (folder ? folders : files) return std::string{};
            return fmt::format("found the {} '{}', accepted a {}", folder ? "folder" : "file", text, accepted);
          },
          shown_in_help};
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

/// CLI11 takes the whole path of the program if it has no other name.
std::string name_of_program(const CLI::App& app) {
  const std::string& name = app.get_name();
  return name.substr(name.rfind('/') + 1);
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

CLI::Validator existing_file() { return existing("FILE", true, false); }
CLI::Validator existing_folder() { return existing("FOLDER", false, true); }
CLI::Validator existing_path() { return existing("PATH", true, true); }

std::string explain_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& sub = chosen_subcommand(app);
  std::string subcommands;
  for (const CLI::App* at = &sub; at->get_parent(); at = at->get_parent())
    subcommands = " " + at->get_name() + subcommands;
  const std::string help = name_of_program(app) + subcommands + " --help";
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

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  constexpr int kWrongUsage = 64;
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string name = name_of_program(app);
    fmt::print(stderr, "{}: {}\n", name.substr(name.rfind(' ') + 1), explain_parse_error(app, error));
    return kWrongUsage;
  }
}

}  // namespace constrictor
