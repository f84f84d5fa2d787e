#include "cli/usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "cyclone/run_token.hpp"

namespace constrictor::cli {

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

}  // namespace constrictor::cli
