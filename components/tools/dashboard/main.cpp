// dashboard: shows a run in web browsers and in Foxglove.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "client/command_error.hpp"
#include "client/run_registry.hpp"
#include "component/data_path.hpp"
#include "dashboard/dashboard.hpp"
#include "runtime/host.hpp"
#include "runtime/version_text.hpp"

namespace {

using namespace constrictor;

volatile std::sig_atomic_t g_signal = 0;

/// Host and port for a browser on this host.
std::string place_of(const dashboard::WebOptions& web, std::uint16_t port) {
  const bool every = web.address == "0.0.0.0" || web.address == "::";
  const bool v6 = web.address.find(':') != std::string::npos;
  return fmt::format("{}:{}", every ? "localhost" : v6 ? "[" + web.address + "]" : web.address, port);
}

int show(std::optional<std::uint32_t> run, dashboard::WebOptions web) {
  web.page = data_path("components/tools/dashboard/page");
  const RunNote note = join_run(run);
  dashboard::Dashboard board(note, web);
  const std::string place = place_of(web, board.server().port());
  fmt::print("run {}: http://{} for a browser, ws://{} for Foxglove; Ctrl-C ends the dashboard, not the run\n",
             note.domain, place, place);
  if (!board.server().on_this_host_only())
    fmt::print("everybody who can reach {} may watch and command the run\n", web.address);
  std::fflush(stdout);
  while (g_signal == 0 && board.over().empty()) board.serve();
  if (board.server().dropped() > 0)
    fmt::print("{} messages were dropped, because viewers were too slow for them\n", board.server().dropped());
  if (g_signal != 0) return 128 + g_signal;
  fmt::print("{}\n", board.over());
  return exit_status::kOk;
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::uint32_t> run;
  std::string token_file;
  dashboard::WebOptions web;
  CLI::App app{"Shows a run in a web browser and in Foxglove."};
  app.set_version_flag("--version", [] { return version_text("dashboard"); });
  app.add_option("--run", run, "DDS domain of the run, as `constrictor run` prints it (default: the only run here)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(CLI::Range(0, 229));
  app.add_option("--token-file", token_file, "file with the token of a run that was started on another host")
      ->check(CLI::ExistingFile);
  app.add_option("--port", web.port, "TCP port for web pages and WebSockets; 0: a free one")->capture_default_str();
  app.add_option(
         "--address", web.address,
         "IP address to listen on; 0.0.0.0 for viewers on other hosts: everybody there may then command the run")
      ->capture_default_str();
  app.add_option("--allow-origin", web.origins,
                 "web site whose pages may watch (not command), such as https://app.foxglove.dev; may be repeated")
      ->allow_extra_args(false);
  app.footer(
      "The page shows scene, camera, torques, state of the mission, events and processes; it can pause and step the\n"
      "run and stop the robot. Foxglove and Lichtblick connect to the same port (\"Foxglove WebSocket\") and see "
      "every\n"
      "topic, and the 3D scene as view/scene. The run does not wait for the dashboard or its viewers; a viewer that "
      "is\n"
      "too slow loses its oldest messages.\n\n"
      "EXAMPLES\n  dashboard\n  dashboard --port 0\n  dashboard --run 3 --address 0.0.0.0\n\n"
      "EXIT STATUS\n  0 the run has ended; 64 wrong usage; 70 no run, or the port cannot be opened; 130 Ctrl-C, 143 "
      "SIGTERM");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
  }
  if (!token_file.empty()) ::setenv("CONSTRICTOR_TOKEN_FILE", token_file.c_str(), 1);
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  try {
    return show(run, web);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dashboard: %s\n", error.what());
    return exit_status::kSoftware;
  }
}
