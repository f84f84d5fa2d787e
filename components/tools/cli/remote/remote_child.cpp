#include "cli/remote/remote_child.hpp"

#include <csignal>

#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

constexpr auto kKillBound = std::chrono::seconds(8);  // for the report that a killed process has ended

}  // namespace

RemoteChild::~RemoteChild() {
  if (!poll()) signal(SIGKILL);
}

const std::optional<ChildExit>& RemoteChild::poll() {
  if (exit_) return exit_;
  link_.exchange();
  const HostLink::Process& process = link_.process(process_);
  exit_ = process.exit;
  if (!exit_ && process.lost) exit_ = ChildExit{exit_status::kWaitedTooLong << 8, 0};
  if (!exit_ && killed_at_ && !link_.up() && std::chrono::steady_clock::now() - *killed_at_ > kKillBound)
    exit_ = ChildExit{SIGKILL, 0};
  return exit_;
}

void RemoteChild::signal(int number) {
  if (exit_) return;
  if (number == SIGKILL && !killed_at_) killed_at_ = std::chrono::steady_clock::now();
  link_.signal(process_, number);
  link_.exchange();
}

}  // namespace constrictor::cli
