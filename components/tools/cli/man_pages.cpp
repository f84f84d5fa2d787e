// `constrictor man-pages`: the help of all subcommands as manual pages.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

/// Text for roff: nothing in it is a command, and a hyphen is one that can be copied into a shell.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char character : text) {
    if (line_begins && (character == '.' || character == '\'')) escaped += "\\&";
    line_begins = character == '\n';
    if (character == '\\') escaped += "\\e";
    else if (character == '-') escaped += "\\-";
    else if (character == '\'') escaped += "\\(aq";
    else if (character == '`') escaped += "\\(ga";
    else if (character == '^') escaped += "\\(ha";
    else if (character == '~') escaped += "\\(ti";
    else escaped += character;
  }
  return escaped;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \n") - first + 1);
}

/// Text whose line breaks do not matter: one paragraph for each part between empty lines.
std::string filled(const std::string& text) {
  std::istringstream lines(trimmed(text));
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    result += line.empty() ? ".PP\n" : roff(line) + "\n";
  }
  return result;
}

/// The parts of a help footer, by heading; "" is the part before the first heading.
std::map<std::string, std::string> footer_parts(const std::string& footer) {
  std::map<std::string, std::string> parts;
  std::string heading;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line == "EXAMPLES" || line == "EXIT STATUS" || line == "ENVIRONMENT") heading = line;
    else parts[heading] += line + "\n";
  }
  return parts;
}

std::string examples(const std::string& text) {
  std::istringstream lines(text);
  std::string result = ".nf\n";
  for (std::string line; std::getline(lines, line);) {
    if (!trimmed(line).empty()) result += roff(trimmed(line)) + "\n";
  }
  return result + ".fi\n";
}

/// "0 done; 1 refused" as a list.
std::string exit_statuses(const std::string& text) {
  std::istringstream lines(text);
  std::string joined;
  for (std::string line; std::getline(lines, line);) joined += (joined.empty() ? "" : " ") + trimmed(line);
  std::string result;
  std::size_t at = 0;
  while (at < joined.size()) {
    const auto end = std::min(joined.find("; ", at), joined.size());
    const std::string item = trimmed(joined.substr(at, end - at));
    at = end + 2;
    const auto blank = item.find(' ');
    const bool numbered = !item.empty() && std::isdigit(static_cast<unsigned char>(item[0])) != 0;
    if (numbered && blank != std::string::npos)
      result += fmt::format(".TP\n.B {}\n{}\n", item.substr(0, blank), roff(item.substr(blank + 1)));
    else if (!item.empty()) result += roff(item) + "\n";
  }
  return result;
}

/// "NAME  meaning" in each line as a list; other lines as text.
std::string environment(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    const auto gap = line.find("  ");
    if (gap == std::string::npos) result += line.empty() ? "" : roff(line) + "\n";
    else result += fmt::format(".TP\n.B {}\n{}\n", roff(line.substr(0, gap)), roff(trimmed(line.substr(gap))));
  }
  return result;
}

std::string value_name(const CLI::Option& option) {
  if (!option.get_option_text().empty()) return option.get_option_text();
  return option.get_items_expected_max() == 0 ? "" : option.get_type_name();
}

std::string option_item(const CLI::Option& option) {
  const bool positional = option.get_positional();
  std::string name;
  if (positional) {
    name = fmt::format("\\fI{}\\fR", roff(option.get_name(true)));
  } else {
    std::istringstream names(option.get_name(false, true));
    for (std::string one; std::getline(names, one, ',');)
      name += (name.empty() ? "\\fB" : ", \\fB") + roff(one) + "\\fR";
    if (!value_name(option).empty()) name += fmt::format(" \\fI{}\\fR", roff(value_name(option)));
  }
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += fmt::format(" (default: {})", option.get_default_str());
  if (!option.get_envname().empty()) text += fmt::format(" (environment: {})", option.get_envname());
  return fmt::format(".TP\n{}\n{}", name, filled(text));
}

/// The options of an app and of its option groups, which CLI11 represents as subcommands without a name.
void collect(const CLI::App& app, std::vector<const CLI::Option*>& options) {
  for (const CLI::Option* option : app.get_options()) options.push_back(option);
  for (const CLI::App* group : app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); })) {
    if (group != &app) collect(*group, options);
  }
}

std::vector<const CLI::App*> named_subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty() && !sub->get_group().empty(); });
}

std::string synopsis(const CLI::App& app, const std::string& path) {
  std::string text = fmt::format("\\fB{}\\fR", roff(path));
  std::vector<const CLI::Option*> options;
  collect(app, options);
  for (const CLI::Option* option : options) {
    if (!option->get_positional()) continue;
    const bool several = option->get_items_expected_max() > 1;
    const std::string name = fmt::format("\\fI{}\\fR{}", roff(option->get_name(true)), several ? " ..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + (named_subcommands(app).empty() ? " [\\fIOPTIONS\\fR]" : " \\fICOMMAND\\fR");
}

std::string option_list(const CLI::App& app, bool with_help = true) {
  std::vector<const CLI::Option*> options;
  collect(app, options);
  std::string text;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : options) {
      const bool shown = with_help || !option->check_lname("help");
      if (option->get_positional() == positional && shown) text += option_item(*option);
    }
  }
  return text;
}

std::string section(const std::string& heading, const std::string& text) {
  return trimmed(text).empty() ? "" : fmt::format(".SH {}\n{}", heading, text);
}

std::string dashed(std::string path) {
  std::replace(path.begin(), path.end(), ' ', '-');
  return path;
}

/// The page of a subcommand, with those below it; or of the command itself.
std::string page(const CLI::App& app, const std::string& path, const std::string& date) {
  std::string title = dashed(path);
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  auto parts = footer_parts(app.get_footer());
  const bool whole = app.get_parent() == nullptr;
  std::string text =
      fmt::format(".TH \"{}\" 1 \"{}\" \"constrictor {}\" \"Constrictor\"\n", roff(title), date, kVersion);
  // Its own description begins with its name.
  const std::string what = whole ? "runs, observes and commands modular snake robots" : app.get_description();
  text += section("NAME", fmt::format("{} \\- {}\n", roff(dashed(path)), roff(what)));
  text += section("SYNOPSIS", synopsis(app, path) + "\n");
  text += section("DESCRIPTION", whole ? roff(app.get_description()) + "\n" : filled(parts[""]));
  text += section("OPTIONS", option_list(app));
  std::string below;
  for (const CLI::App* sub : named_subcommands(app)) {
    if (whole) {
      below +=
          fmt::format(".TP\n\\fBconstrictor\\-{}\\fR(1)\n{}\n", roff(sub->get_name()), roff(sub->get_description()));
      continue;
    }
    // CLI11 gives a subcommand without a footer that of its parent.
    auto own = footer_parts(sub->get_footer() == app.get_footer() ? "" : sub->get_footer());
    below += fmt::format(".SS \"{} {}\"\n{}.PP\n{}\n", roff(path), roff(sub->get_name()),
                         roff(sub->get_description()) + ".\n", synopsis(*sub, path + " " + sub->get_name()));
    if (!trimmed(own[""]).empty()) below += ".PP\n" + filled(own[""]);
    below += option_list(*sub, false);
    parts["EXAMPLES"] += own["EXAMPLES"];
  }
  text += section("COMMANDS", below);
  text += trimmed(parts["EXAMPLES"]).empty() ? "" : section("EXAMPLES", examples(parts["EXAMPLES"]));
  text += section("EXIT STATUS", exit_statuses(parts["EXIT STATUS"]));
  text += section("ENVIRONMENT", environment(parts["ENVIRONMENT"]));
  return text + section("SEE ALSO", whole ? "The pages of the subcommands.\n" : "\\fBconstrictor\\fR(1)\n");
}

void write_page(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace

void add_man_pages(CLI::App& app, Action& action, const std::string& date) {
  auto folder = std::make_shared<std::string>();
  auto* sub = app.add_subcommand("man-pages", "write the manual pages of this command and of its subcommands");
  sub->add_option("DIR", *folder, "folder for the files constrictor.1, constrictor-run.1 ...; it is made if need be")
      ->required();
  sub->footer(help_footer("The package installs the pages: man constrictor, man constrictor-run.",
                          {"constrictor man-pages /tmp/man && man /tmp/man/constrictor-run.1"},
                          "0 done; 64 wrong usage; 70 a file cannot be written", "none"));
  sub->callback([&action, &app, folder, date] {
    action = [&app, folder, date] {
      const std::filesystem::path into = *folder;
      std::error_code error;
      std::filesystem::create_directories(into, error);
      if (error)
        throw std::runtime_error(
            fmt::format("DIR: found {}, which cannot be made ({}), accepted a folder in which "
                        "files can be written",
                        into.string(), error.message()));
      write_page(into / "constrictor.1", page(app, "constrictor", date));
      for (const CLI::App* each : named_subcommands(app)) {
        const std::string path = "constrictor " + each->get_name();
        write_page(into / (dashed(path) + ".1"), page(*each, path, date));
      }
      return exit_status::kOk;
    };
  });
}

}  // namespace constrictor::cli
