// `constrictor agent`: what the launcher starts over ssh on another host.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/remote/agent.hpp"
#include "cli/remote/host_description.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "constrictor/json.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct AgentOptions {
  std::string token;
  bool attach = false;
  bool describe = false;
};

/// A connection to the agent of this run; not open if there is none.
Descriptor connect_to_agent(const std::string& token) {
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (agent_folder(token) / "socket").string();
  if (path.size() >= sizeof(address.sun_path)) return {};
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) return {};
  return socket;
}

/// Starts the agent as a process that outlives this one. Returns when it can be reached. Throws std::runtime_error.
void start_agent(const std::string& token) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("agent: cannot make a pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("agent: cannot start a process");
  if (child > 0) {
    ::close(pipe[1]);
    std::string result;
    std::array<char, 256> bytes{};
    for (ssize_t count = 0; (count = ::read(pipe[0], bytes.data(), bytes.size())) > 0;)
      result.append(bytes.data(), static_cast<std::size_t>(count));
    ::close(pipe[0]);
    if (result != "ready") throw std::runtime_error("agent: " + (result.empty() ? "it died at its start" : result));
    return;
  }
  ::setsid();
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  const auto report = [&](const std::string& text) {
    static_cast<void>(!::write(pipe[1], text.data(), text.size()));
    ::close(pipe[1]);
  };
  int status = exit_status::kSoftware;
  try {
    Agent agent(token);
    report("ready");
    status = agent.run();
  } catch (const std::exception& error) {
    report(error.what());
  }
  ::_exit(status);
}

bool write_all(int descriptor, const char* bytes, ssize_t count) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, static_cast<std::size_t>(count));
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes += written, count -= written;
  }
  return true;
}

/// Copies between the standard streams and the agent's socket until one of them is closed.
void relay(const Descriptor& agent) {
  std::array<char, 65536> bytes{};
  std::array<pollfd, 2> waits{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{agent.get(), POLLIN, 0}};
  while (true) {
    if (::poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) return;
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].revents == 0) continue;
      const ssize_t count = ::read(waits[i].fd, bytes.data(), bytes.size());
      if (count <= 0 || !write_all(i == 0 ? agent.get() : STDOUT_FILENO, bytes.data(), count)) return;
    }
  }
}

int agent(const AgentOptions& options) {
  if (options.describe) {
    fmt::print("{}\n", json_text(describe_this_host(), 1));
    return exit_status::kOk;
  }
  if (!is_plain_name(options.token)) throw UsageError("--token: found '" + options.token + "', accepted " + kPlainName);
  ::signal(SIGPIPE, SIG_IGN);
  try {
    Descriptor connection = connect_to_agent(options.token);
    if (!connection.open() && options.attach) {
      fmt::print("{{\"op\": \"gone\"}}\n");
      return exit_status::kOk;
    }
    if (!connection.open()) {
      start_agent(options.token);
      connection = connect_to_agent(options.token);
    }
    relay(connection);
    return exit_status::kOk;
  } catch (const std::exception& error) {
    fmt::print("{}\n", json_text(nlohmann::json{{"op", "error"}, {"text", error.what()}}));
    return exit_status::kSoftware;
  }
}

}  // namespace

void add_agent(CLI::App& app, Action& action) {
  auto options = std::make_shared<AgentOptions>();
  auto* sub =
      add_subcommand(app, "agent", "run the processes of another host's run; `constrictor run` starts it by ssh",
                     action, options, agent);
  sub->add_option("--token", options->token, "name of the run, chosen by its launcher");
  sub->add_flag("--attach", options->attach, "connect to the agent that runs already; start none");
  sub->add_flag("--describe", options->describe, "print release, libraries and numeric profile of this host, and exit");
  sub->footer(help_footer(
      "The launcher of a manifest with hosts starts this command on each of them. It starts the agent of the run, if "
      "it\n"
      "does not run yet, and connects standard input and output with it. The agent starts and watches the processes "
      "of\n"
      "this host. It survives a broken connection for the patience of the run; then it kills its processes.",
      {"constrictor agent --describe"}, "0; 64 wrong usage; 70 the agent cannot be started",
      "XDG_RUNTIME_DIR  the agent's files are below constrictor/ in it"));
}

}  // namespace constrictor::cli
