#include "sim/emulation/emulator_process.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>

#include "configuration/command_line.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::emulation {
namespace {

volatile std::sig_atomic_t g_stop = 0;
pid_t g_parent = 0;

void on_signal(int) { g_stop = 1; }

}  // namespace

bool runs_on() { return !g_stop && ::getppid() == g_parent; }

int run_emulator(const std::string& name, CLI::App& app, int argc, char** argv,
                 const std::function<void(const Log& log)>& emulate) {
  g_parent = ::getppid();
  app.set_version_flag("--version", name + " " CONSTRICTOR_VERSION, "print the release");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  const Log log(name);
  try {
    emulate(log);
    return 0;
  } catch (const ConfigurationError& error) {
    log.error("configuration: {}", error.what());
    return 78;
  } catch (const std::exception& error) {
    log.error("{}", error.what());
    return 70;
  }
}

void obey_commands(CommandPipe& pipe, const Log& log,
                   const std::function<std::string(const std::string& line)>& command) {
  pipe.read([&](const std::string& line) {
    const std::string refusal = command(line);
    if (refusal.empty()) log.info("obeys '{}'", line);
    else log.warning("refuses a command: {}", refusal);
  });
}

}  // namespace constrictor::emulation
