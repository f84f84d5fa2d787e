// One ssh process, and the messages that it carries to the agent of another host.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>

#include "cli/manifest.hpp"
#include "cli/remote/message_channel.hpp"

namespace constrictor::cli {

class SshConnection {
 public:
  /// Starts ssh with the command that finds the installation of this release on the host and starts its agent. The
  /// kernel kills ssh when the thread that called this ends. `attach`: only connects to an agent that runs already.
  /// The environment variable CONSTRICTOR_SSH replaces "ssh", for example by "ssh -F my_config". Throws
  /// std::system_error.
  SshConnection(const HostPlan& host, const std::string& token, bool attach);
  ~SshConnection();  ///< kills ssh
  SshConnection(const SshConnection&) = delete;
  SshConnection& operator=(const SshConnection&) = delete;

  [[nodiscard]] MessageChannel& channel() { return *channel_; }
  /// Whether ssh has ended. Never waits.
  [[nodiscard]] bool ended();
  /// The last line that ssh, or a login shell, has written to standard error; "ended with status 255" if there is none.
  [[nodiscard]] std::string last_error() const;

 private:
  pid_t pid_ = -1;
  int wait_status_ = 0;
  Descriptor errors_;  ///< a file in memory
  std::unique_ptr<MessageChannel> channel_;
};

/// The command that ssh executes on the host: sh finds an installation of this release and starts its agent.
[[nodiscard]] std::string remote_command(const HostPlan& host, const std::string& token, bool attach);

}  // namespace constrictor::cli
