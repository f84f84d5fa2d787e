#include "cli/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <system_error>

#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (const auto& text : texts) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

const char* meaning(int code) {
  switch (code) {
    case exit_status::kUsage:
      return " (usage)";
    case exit_status::kSoftware:
      return " (error)";
    case exit_status::kWaitedTooLong:
      return " (waited too long for another process)";
    case exit_status::kRefused:
      return " (refused by the run)";
    case exit_status::kConfiguration:
      return " (configuration)";
    case kNoSuchProgram:
      return " (program not found)";
    default:
      return "";
  }
}

}  // namespace

std::optional<int> ChildExit::code() const {
  if (WIFEXITED(wait_status)) return WEXITSTATUS(wait_status);
  return std::nullopt;
}

std::string ChildExit::describe() const {
  if (const auto status = code()) return fmt::format("ended with status {}{}", *status, meaning(*status));
  return fmt::format("was killed by signal {} ({})", WTERMSIG(wait_status), ::strsignal(WTERMSIG(wait_status)));
}

pid_t fork_bound_to_caller() {
  sigset_t none;
  ::sigemptyset(&none);
  const pid_t launcher = ::getpid();
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != launcher) ::_exit(exit_status::kSoftware);  // the launcher died before prctl
  ::signal(SIGPIPE, SIG_DFL);                                    // the launcher ignores it
  ::setpgid(0, 0);  // Ctrl-C must reach only the launcher, which ends its processes in order
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  return 0;
}

ChildProcess::ChildProcess(const std::vector<std::string>& argv, const std::vector<std::string>& environment,
                           const std::filesystem::path& log) {
  // All memory is allocated before the fork: during the fork, another thread may hold the lock of the heap.
  const auto arguments = pointers(argv);
  const auto variables = pointers(environment);
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (output < 0) throw std::system_error(errno, std::generic_category(), log.string());
  pid_ = fork_bound_to_caller();
  if (pid_ == 0) {
    const int input = ::open("/dev/null", O_RDONLY);
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execve(arguments[0], arguments.data(), variables.data());
    const char* reason = ::strerrordesc_np(errno);
    static_cast<void>(!::write(STDERR_FILENO, arguments[0], std::strlen(arguments[0])));
    static_cast<void>(!::write(STDERR_FILENO, ": ", 2));
    static_cast<void>(!::write(STDERR_FILENO, reason, std::strlen(reason)));
    static_cast<void>(!::write(STDERR_FILENO, "\n", 1));
    ::_exit(kNoSuchProgram);
  }
  const int error = errno;
  ::close(output);
  if (pid_ < 0) throw std::system_error(error, std::generic_category(), "fork");
}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0 || exit_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

const std::optional<ChildExit>& ChildProcess::poll() {
  if (exit_) return exit_;
  int status = 0;
  rusage usage{};
  if (::wait4(pid_, &status, WNOHANG, &usage) == pid_)
    exit_ = ChildExit{status, seconds(usage.ru_utime) + seconds(usage.ru_stime)};
  return exit_;
}

void ChildProcess::signal(int number) {
  if (!exit_) ::kill(pid_, number);
}

double ChildProcess::pss_mib() const {
  std::ifstream file(fmt::format("/proc/{}/smaps_rollup", pid_));
  for (std::string word; file >> word;) {
    double kib = 0;
    if (word == "Pss:" && file >> kib) return kib / 1024.0;
  }
  return 0;
}

std::vector<std::string> last_lines(const std::filesystem::path& log, std::uintmax_t offset, std::size_t count) {
  std::ifstream file(log);
  std::error_code missing;
  // A log that became too large has been emptied (bound_log()).
  if (offset <= std::filesystem::file_size(log, missing)) file.seekg(static_cast<std::streamoff>(offset));
  std::deque<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.pop_front();
  }
  return {lines.begin(), lines.end()};
}

}  // namespace constrictor::cli
