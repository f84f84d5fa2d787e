// The common parts of the programs of emulated devices: their command line, their end, and the commands to them.
#pragma once

#include <functional>
#include <string>

#include "log/log.hpp"
#include "sim/emulation/command_pipe.hpp"

namespace CLI {
class App;
}

namespace constrictor::emulation {

/// False after SIGTERM or SIGINT, and when the process that started this one has ended: an emulator must not be left
/// behind. Only inside of run_emulator().
[[nodiscard]] bool runs_on();

/// The main function of the emulator `name`: reads the command line, to which it adds `--version`, calls `emulate` and
/// reports exceptions. Returns the exit status: 0 after `emulate`, 64 for wrong usage, 78 for a ConfigurationError, 70
/// for other exceptions.
[[nodiscard]] int run_emulator(const std::string& name, CLI::App& app, int argc, char** argv,
                               const std::function<void(const Log& log)>& emulate);

/// Obeys all commands that have arrived, and logs each of them. `command` carries a line out and returns why it refuses
/// the line; empty: it has obeyed. Never waits.
void obey_commands(CommandPipe& pipe, const Log& log,
                   const std::function<std::string(const std::string& line)>& command);

}  // namespace constrictor::emulation
