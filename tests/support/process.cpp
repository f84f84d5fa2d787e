#include "support/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "support/eventually.hpp"

namespace constrictor::testing {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(2);

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

}  // namespace

Process::Process(std::vector<std::string> arguments, const std::map<std::string, std::string>& environment) {
  folder_ = std::make_unique<TemporaryFolder>();
  std::vector<char*> argv;
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const std::string out = folder_->path() / "out";
  const std::string err = folder_->path() / "err";
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // the kernel kills this child when the test program ends
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  ::dup2(::open(out.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600), 1);
  ::dup2(::open(err.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600), 2);
  ::execvp(argv[0], argv.data());
  ::_exit(127);
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), status_(other.status_), folder_(std::move(other.folder_)) {}

Process& Process::operator=(Process&& other) noexcept {
  if (this != &other) {
    discard();
    pid_ = std::exchange(other.pid_, -1);
    status_ = other.status_;
    folder_ = std::move(other.folder_);
  }
  return *this;
}

Process::~Process() { discard(); }

void Process::discard() {
  if (pid_ > 0 && running()) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  pid_ = -1;
  folder_.reset();
}

void Process::signal(int number) const { ::kill(pid_, number); }

bool Process::running() {
  if (status_) return false;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == 0) return true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

std::optional<int> Process::wait(std::chrono::seconds bound) {
  (void)eventually([this] { return !running(); }, bound, kPoll);
  return status_;
}

std::string Process::output() const { return read_file(folder_->path() / "out"); }
std::string Process::errors() const { return read_file(folder_->path() / "err"); }

bool Process::wait_for(const std::string& text, std::chrono::seconds bound) {
  bool found = false;
  const auto found_or_ended = [&] {
    const bool alive = running();  // asked first: the output of an ended process is complete
    found = output().find(text) != std::string::npos || errors().find(text) != std::string::npos;
    return found || !alive;
  };
  return eventually(found_or_ended, bound, kPoll) && found;
}

unsigned domain_of(Process& run) {
  if (!run.wait_for("report in", std::chrono::seconds(15))) return 0;
  const std::string output = run.output();
  return static_cast<unsigned>(std::stoul(output.substr(output.find("run ") + 4)));
}

}  // namespace constrictor::testing
