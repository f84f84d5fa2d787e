#include "cli/remote/ssh_connection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "cli/child_process.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

constexpr std::size_t kShownErrors = 4;

std::vector<std::string> ssh_command() {
  const char* chosen = std::getenv("CONSTRICTOR_SSH");
  std::istringstream words(chosen && *chosen ? chosen : "ssh");
  std::vector<std::string> command;
  for (std::string word; words >> word;) command.push_back(word);
  // No question may be asked, and no connection may be shared with, or outlive, this process.
  for (const char* option :
       {"-T", "-o", "BatchMode=yes", "-o", "ConnectTimeout=10", "-o", "ControlMaster=no", "-o", "ControlPath=none"})
    command.emplace_back(option);
  return command;
}

}  // namespace

std::string remote_command(const HostPlan& host, const std::string& token, bool attach) {
  std::string given = host.directory.string();
  if (given.starts_with("~/")) given.replace(0, 1, "\"$HOME\"");
  const std::string places =
      given.empty() ? "\"$(command -v constrictor)\" /opt/constrictor*/bin/constrictor /usr/local/bin/constrictor "
                      "\"$HOME\"/constrictor/build/release/bin/constrictor"
                    : fmt::format("{0}/bin/constrictor {0}/build/release/bin/constrictor {0}/constrictor", given);
  // The text contains no single quote, because the login shell, which may be any, receives it as one quoted word.
  return fmt::format(
      "exec sh -c 'for program in {}; do [ -f \"$program\" ] && [ -x \"$program\" ] || continue; "
      "version=$(\"$program\" --version 2>/dev/null | sed -n \"1s/^constrictor //;1p\"); [ \"$version\" = {} ] && exec "
      "\"$program\" agent --token {}{}; "
      "found=\"$found $program is $version;\"; done; "
      "printf \"{{\\\"op\\\": \\\"no release\\\", \\\"text\\\": \\\"%s\\\"}}\\n\" \"$found\"'",
      places, kVersion, token, attach ? " --attach" : "");
}

SshConnection::SshConnection(const HostPlan& host, const std::string& token, bool attach) {
  std::vector<std::string> command = ssh_command();
  command.push_back("--");
  command.push_back(host.ssh);
  command.push_back(remote_command(host, token, attach));
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (auto& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  errors_ = Descriptor(::memfd_create("ssh", MFD_CLOEXEC));
  std::array<int, 2> sockets{};
  if (!errors_.open() || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "ssh");
  Descriptor ours(sockets[0]), theirs(sockets[1]);
  pid_ = fork_bound_to_caller();
  if (pid_ == 0) {
    ::dup2(theirs.get(), STDIN_FILENO);
    ::dup2(theirs.get(), STDOUT_FILENO);
    ::dup2(errors_.get(), STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    static constexpr char kNoSsh[] = "cannot start ssh; install openssh-client\n";
    static_cast<void>(!::write(STDERR_FILENO, kNoSsh, sizeof(kNoSsh) - 1));
    ::_exit(kNoSuchProgram);
  }
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  channel_ = std::make_unique<MessageChannel>(std::move(ours));
}

SshConnection::~SshConnection() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

bool SshConnection::ended() {
  if (pid_ > 0 && ::waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ < 0;
}

std::string SshConnection::last_error() const {
  const auto lines = last_lines(fmt::format("/proc/self/fd/{}", errors_.get()), 0, kShownErrors);
  if (lines.empty()) return "ssh " + ChildExit{wait_status_, 0}.describe();
  std::string text = lines.back();
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  return text;
}

}  // namespace constrictor::cli
