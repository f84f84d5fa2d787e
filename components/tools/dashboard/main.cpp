// dashboard: shows a run in web browsers and in Foxglove.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "client/command_error.hpp"
#include "client/run_registry.hpp"
#include "common/replay_control.hpp"
#include "component/data_path.hpp"
#include "configuration/command_line.hpp"
#include "dashboard/commands.hpp"
#include "dashboard/dashboard.hpp"
#include "dashboard/replay_controls.hpp"
#include "log/log.hpp"
#include "runtime/git_revision.hpp"
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

/// The source that is shown: its name, and how it is commanded.
struct Shown {
  std::string name;
  std::unique_ptr<dashboard::Controls> controls;
  const char* after;  ///< what continues after the end of this program
};

/// The run or the replay in `domain`; without a domain the only run on this host, or else the only replay.
Shown find(std::optional<std::uint32_t> domain) {
  const Log log("dashboard");
  const auto replays = live_replays();
  const bool wanted = domain && std::find(replays.begin(), replays.end(), *domain) != replays.end();
  if (wanted || (!domain && replays.size() == 1 && live_runs().empty())) {
    auto controls = std::make_unique<dashboard::ReplayControls>(domain.value_or(replays.front()), log);
    const std::string name = fmt::format("replay {} of {}", domain.value_or(replays.front()), controls->file());
    return {name, std::move(controls), "replay"};
  }
  if (!domain && replays.size() > 1 && live_runs().empty())
    throw CommandError(
        fmt::format("several replays on this host; choose one: --run {}", fmt::join(replays, ", --run ")),
        CommandError::Cause::kNoRun);
  const RunNote note = join_run(domain);
  return {fmt::format("run {}", note.domain), std::make_unique<dashboard::Commands>(note, log), "run"};
}

int show(std::optional<std::uint32_t> domain, dashboard::WebOptions web) {
  web.page = data_path("components/tools/dashboard/page");
  web.made["/tasks.json"] = dashboard::task_forms();
  Shown shown = find(domain);
  dashboard::Dashboard board(std::move(shown.controls), "Constrictor " + shown.name, web);
  const std::string place = place_of(web, board.server().port());
  fmt::print("{}: http://{} for a browser, ws://{} for Foxglove; Ctrl-C ends the dashboard, not the {}\n", shown.name,
             place, place, shown.after);
  if (!board.server().on_this_host_only())
    fmt::print("everybody who can reach {} may watch and command the run\n", web.address);
  std::fflush(stdout);
  while (g_signal == 0 && board.over().empty()) board.serve();
  if (!board.over().empty()) board.say_farewell();
  if (board.server().dropped() > 0)
    fmt::print(
        "{} dropped, because viewers were too slow\n",
        board.server().dropped() == 1 ? "1 message was" : fmt::format("{} messages were", board.server().dropped()));
  if (g_signal != 0) return 128 + g_signal;
  fmt::print("{}\n", board.over());
  std::fflush(stdout);
  return exit_status::kOk;
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::uint32_t> run;
  std::string token_file;
  dashboard::WebOptions web;
  CLI::App app{"Shows a run, or the replay of a recording, in a web browser and in Foxglove.", "constrictor dashboard"};
  app.set_version_flag("--version", [] { return version_text("dashboard", kGitRevision); });
  app.add_option("--run", run,
                 "DDS domain of the run or replay, as `constrictor run` and `replay` print it (default: the only run\n"
                 "here, or else the only replay)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  app.add_option("--token-file", token_file, "file with the token of a run that was started on another host")
      ->check(existing_file());
  app.add_option("--port", web.port, "TCP port for web pages and WebSockets; 0: a free one")
      ->check(whole_number(0, 65535))
      ->capture_default_str();
  app.add_option(
         "--address", web.address,
         "IP address to listen on; 0.0.0.0 for viewers on other hosts: everybody there may then command the run")
      ->capture_default_str()
      ->check(dashboard::wrong_address);
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
      "EXAMPLES\n  constrictor dashboard\n  constrictor dashboard --port 0\n  constrictor dashboard --run 3 --address "
      "0.0.0.0\n\n"
      "EXIT STATUS\n  0 the run has ended; 64 wrong usage; 70 no run, or the port cannot be opened; 130 Ctrl-C, 143 "
      "SIGTERM");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
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
