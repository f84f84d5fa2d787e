#include "cli/usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace constrictor::cli {

CLI::Validator whole_number() {
  return {[](std::string& text) {
            const bool whole = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            return whole ? std::string{} : fmt::format("found '{}', accepted a whole number from 0 on", text);
          },
          ""};
}

void add_run_option(CLI::App& app, std::optional<std::uint32_t>& domain) {
  app.add_option("--run", domain, "the run, by its DDS domain (default: the only one there is)")
      ->envname("CONSTRICTOR_DOMAIN")->check(whole_number())->check(CLI::Range(0, 229));
}

std::string help_footer(const std::string& about, std::initializer_list<const char*> examples, const std::string& exit_status) {
  std::string text = about + (about.empty() ? "" : "\n\n") + "EXAMPLES\n";
  for (const char* example : examples) text += fmt::format("  {}\n", example);
  return text + "\nEXIT STATUS\n  " + exit_status +
         "\n\nENVIRONMENT\n  CONSTRICTOR_DOMAIN  the run, like --run\n  CYCLONEDDS_URI      how DDS reaches other hosts (deploy/cyclonedds)";
}

}  // namespace constrictor::cli
