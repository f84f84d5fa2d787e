// Hosts made of Linux namespaces, each with its own network, mounts, processes, host name, installation and sshd, and a
// network between them that loses, delays and reorders frames. Needs root and /dev/net/tun.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "support/command_lines.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class NamespaceHosts {
 public:
  /// Why hosts cannot be made here; empty if they can.
  static std::string missing() {
    if (::geteuid() != 0) return "needs root";
    if (::access("/dev/net/tun", R_OK | W_OK) != 0) return "needs /dev/net/tun";
    if (::access("/usr/sbin/sshd", X_OK) != 0) return "needs openssh-server (scripts/setup.sh tests)";
    return "";
  }

  /// Makes `count` hosts host1, host2 ... with the addresses 10.77.0.1, 10.77.0.2 ... Their installations contain
  /// `programs` of this build and the YAML files of `source`.
  NamespaceHosts(int count, const std::vector<std::string>& programs, const std::filesystem::path& source) {
    run({"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", (root() / "key").string()});
    for (int i = 1; i <= count; ++i) make(i, programs, source);
    std::string network = "exec " + program("lossy_network");
    for (int i = 1; i <= count; ++i)
      network += " " + tap(i) + "=" + std::to_string(pids_[static_cast<std::size_t>(i) - 1]);
    const std::filesystem::path pipe = root() / "network";
    EXPECT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    control_ = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);  // both ways, so that this does not wait for the reader
    network_ = std::make_unique<Process>(std::vector<std::string>{"sh", "-c", network + " < " + pipe.string()});
    EXPECT_TRUE(network_->wait_for("ok", std::chrono::seconds(10))) << network_->errors();
    for (int i = 1; i <= count; ++i) {
      run({"nsenter", "-t", pid(i), "-n", "ip", "addr", "add", address(i) + "/24", "dev", tap(i)});
      run({"nsenter", "-t", pid(i), "-n", "ip", "link", "set", tap(i), "up"});
    }
  }
  ~NamespaceHosts() {
    ::close(control_);
    for (const pid_t host : pids_) ::kill(host, SIGKILL);  // and with it all processes of the host
  }
  NamespaceHosts(const NamespaceHosts&) = delete;
  NamespaceHosts& operator=(const NamespaceHosts&) = delete;

  static std::string address(int host) { return "10.77.0." + std::to_string(host); }
  /// The folder that is /tmp on the host.
  [[nodiscard]] std::filesystem::path tmp(int host) const { return folder(host) / "tmp"; }
  /// Starts a shell command on a host, in its /tmp.
  [[nodiscard]] Process on(int host, const std::string& command) const {
    return Process({"nsenter", "-t", pid(host), "-n", "-m", "-p", "-u", "env", "-u", "XDG_RUNTIME_DIR", "-u",
                    "CONSTRICTOR_DATA", "PATH=/opt/constrictor/bin:/usr/bin:/bin:/usr/sbin:/sbin", "sh", "-c",
                    "cd /tmp; " + command});
  }
  /// A command for lossy_network: "loss 0.01", "delay 10 2", "blackout 5".
  void network(const std::string& command) const {
    const std::string line = command + "\n";
    EXPECT_EQ(::write(control_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  }
  /// Ends all processes of a host except the first one, as a failure of its power does; empties its /run, and cuts the
  /// network for so many seconds.
  void reboot(int host, int seconds) const {
    network("blackout " + std::to_string(seconds));
    for (const pid_t process : processes(host, "")) {
      if (std::to_string(process) != pid(host)) ::kill(process, SIGKILL);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder(host) / "run")) {
      if (entry.path().filename() != "sshd") std::filesystem::remove_all(entry.path());
    }
  }
  /// The processes of a host whose command line contains `text`, as pids of the test's namespace.
  [[nodiscard]] std::vector<pid_t> processes(int host, const std::string& text) const {
    const auto own = std::filesystem::read_symlink("/proc/" + pid(host) + "/ns/pid");
    std::vector<pid_t> found;
    for (const auto& [number, line] : command_lines()) {
      std::error_code gone;
      const auto its = std::filesystem::read_symlink("/proc/" + std::to_string(number) + "/ns/pid", gone);
      if (!gone && its == own && line.find(text) != std::string::npos) found.push_back(number);
    }
    return found;
  }

 private:
  [[nodiscard]] std::filesystem::path root() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path folder(int host) const { return root() / ("host" + std::to_string(host)); }
  [[nodiscard]] std::string pid(int host) const { return std::to_string(pids_[static_cast<std::size_t>(host) - 1]); }
  static std::string tap(int host) { return "ctap" + std::to_string(host); }
  static void run(const std::vector<std::string>& arguments) {
    Process process(arguments);
    EXPECT_EQ(process.wait(std::chrono::seconds(20)), 0) << arguments[0] << ": " << process.errors();
  }

  void make(int host, const std::vector<std::string>& programs, const std::filesystem::path& source) {
    namespace fs = std::filesystem;
    const fs::path prefix = folder(host) / "prefix", ssh = folder(host) / "ssh";
    for (const fs::path& made : {prefix / "bin", prefix / "libexec/constrictor", prefix / "share/constrictor", ssh,
                                 folder(host) / "tmp", folder(host) / "run"})
      fs::create_directories(made);
    for (const auto& name : programs) fs::copy_file(program(name), prefix / "libexec/constrictor" / name);
    // The modules that programs load when they need them lie beside these.
    for (const auto& entry : fs::directory_iterator(fs::path(program("report")).parent_path())) {
      if (entry.path().extension() == ".so")
        fs::copy_file(entry.path(), prefix / "libexec/constrictor" / entry.path().filename());
    }
    fs::create_symlink("../libexec/constrictor/constrictor", prefix / "bin/constrictor");
    for (const char* part : {"components", "sim", "deploy"}) {
      for (const auto& entry : fs::recursive_directory_iterator(source / part)) {
        if (entry.path().extension() != ".yaml") continue;
        const fs::path copy = prefix / "share/constrictor" / fs::relative(entry.path(), source);
        fs::create_directories(copy.parent_path());
        fs::copy_file(entry.path(), copy);
      }
    }
    run({"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", (ssh / "host_key").string()});
    fs::copy_file(root() / "key", ssh / "key");
    fs::copy_file(root() / "key.pub", ssh / "authorized_keys");
    std::ofstream(ssh / "sshd_config") << "HostKey /etc/ssh/host_key\nAuthorizedKeysFile /etc/ssh/authorized_keys\n"
                                          "StrictModes no\nUsePAM no\nPidFile none\nPermitRootLogin yes\n"
                                          "SetEnv XDG_STATE_HOME=/tmp/state\n";  // the hosts share the home directory
    std::ofstream(ssh / "ssh_config") << "Host *\n  IdentityFile /etc/ssh/key\n  StrictHostKeyChecking no\n"
                                         "  UserKnownHostsFile /dev/null\n  LogLevel ERROR\n";
    hosts_.emplace_back(std::vector<std::string>{
        "unshare", "--net", "--mount", "--pid", "--uts", "--fork", "--mount-proc", "--kill-child",
        (source / "tests/support/namespace_host.sh").string(), "host" + std::to_string(host), folder(host).string()});
    EXPECT_TRUE(hosts_.back().wait_for("Server listening", std::chrono::seconds(20))) << hosts_.back().errors();
    const std::string unshare = std::to_string(hosts_.back().pid());
    pid_t child = 0;
    std::ifstream("/proc/" + unshare + "/task/" + unshare + "/children") >> child;
    EXPECT_GT(child, 0);
    pids_.push_back(child);
  }

  const TemporaryFolder folder_;
  std::vector<Process> hosts_;
  std::vector<pid_t> pids_;  ///< the first process of each host
  std::unique_ptr<Process> network_;
  int control_ = -1;
};

}  // namespace constrictor::testing
