#include "cli/served_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "configuration/whole_file.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kShortestPause = 200ms;
constexpr auto kLongestPause = 10000ms;
constexpr auto kSoon = 5s;  // a process that ends sooner will probably end as soon after its next start
constexpr std::uint32_t kLargestIncarnation = 1'000'000;
constexpr std::size_t kLongestLine = 4096;

}  // namespace

std::uint32_t IncarnationFile::next() {
  std::uint32_t last = 0;
  std::ifstream(file_) >> last;
  const std::uint32_t next = last < kLargestIncarnation ? last + 1 : 1;
  write_whole(file_, fmt::format("{}\n", next));
  return next;
}

ServedProcess::ServedProcess(std::string name, CommandLine command_line, std::vector<std::string> environment,
                             std::filesystem::path incarnation_file, Print print)
    : name_(std::move(name)),
      command_line_(std::move(command_line)),
      environment_(std::move(environment)),
      incarnations_(std::move(incarnation_file)),
      print_(std::move(print)) {
  if (::pipe2(output_, O_CLOEXEC | O_NONBLOCK) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
}

ServedProcess::~ServedProcess() {
  child_.reset();
  for (const int descriptor : output_) ::close(descriptor);
}

void ServedProcess::start() {
  // Opened by its name, the pipe blocks for the process: its log lines are not lost when they come fast.
  child_ = std::make_unique<ChildProcess>(command_line_(incarnations_.next(), same_run_), environment_,
                                          fmt::format("/proc/self/fd/{}", output_[1]));
  started_ = Clock::now();
}

void ServedProcess::forward_output() {
  char bytes[4096];
  for (ssize_t size = 0; (size = ::read(output_[0], bytes, sizeof bytes)) > 0;) {
    for (const char byte : std::string_view(bytes, static_cast<std::size_t>(size))) {
      if (byte != '\n' && unfinished_line_.size() < kLongestLine) {
        unfinished_line_ += byte;
        continue;
      }
      if (!unfinished_line_.empty()) print_(unfinished_line_);
      unfinished_line_.clear();
    }
  }
}

std::optional<int> ServedProcess::handle_exit(const ChildExit& exit) {
  const int code = exit.code().value_or(-1);
  if (code == exit_status::kUsage || code == exit_status::kConfiguration || code == kNoSuchProgram) {
    print_(fmt::format("{} {}; starting it again would not help", name_, exit.describe()));
    return code;
  }
  const bool waited = code == exit_status::kWaitedTooLong;
  same_run_ = code != exit_status::kOk && !waited;
  const bool soon = Clock::now() - started_ < kSoon || code == exit_status::kRefused;
  pause_ =
      exit.clean() || !soon ? 0ms : std::clamp<std::chrono::milliseconds>(2 * pause_, kShortestPause, kLongestPause);
  start_at_ = Clock::now() + pause_;
  if (exit.clean()) print_(fmt::format("{}: the run is over; waiting for the next one", name_));
  else if (!waited) print_(fmt::format("{} {}; starting it again", name_, exit.describe()));
  else if (!waited_) print_(fmt::format("{} still waits for a run", name_));
  waited_ = waited;
  return {};
}

std::optional<int> ServedProcess::poll() {
  forward_output();
  if (!child_) {
    if (!stopping_ && Clock::now() >= start_at_) start();
    return {};
  }
  const auto exit = child_->poll();
  if (!exit) return {};
  forward_output();
  if (!unfinished_line_.empty()) print_(std::exchange(unfinished_line_, {}));
  child_.reset();
  return stopping_ ? std::nullopt : handle_exit(*exit);
}

void ServedProcess::stop(int signal) {
  stopping_ = true;
  if (child_) child_->signal(signal);
}

}  // namespace constrictor::cli
