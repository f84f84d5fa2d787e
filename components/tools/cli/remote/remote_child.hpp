// A process of the run on another host.
#pragma once

#include <chrono>
#include <string>

#include "cli/child_process.hpp"
#include "cli/remote/host_link.hpp"

namespace constrictor::cli {

class RemoteChild : public Child {
 public:
  /// `process` was started with link.start().
  RemoteChild(HostLink& link, std::string process) : link_(link), process_(std::move(process)) {}
  ~RemoteChild() override;

  [[nodiscard]] pid_t pid() const override { return link_.process(process_).pid; }
  /// A process of a host that has been away for longer than the patience counts as ended, with the status for that. So
  /// does, after a bound, a process that was killed on a host that does not answer: its agent kills it.
  const std::optional<ChildExit>& poll() override;
  void signal(int number) override;
  [[nodiscard]] double pss_mib() const override { return link_.process(process_).pss_mib; }

 private:
  HostLink& link_;
  std::string process_;
  std::optional<ChildExit> exit_;
  std::optional<std::chrono::steady_clock::time_point> killed_at_;
};

}  // namespace constrictor::cli
