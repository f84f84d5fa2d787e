// A fixture for runs on two hosts with the real launcher and agents. A script in place of ssh runs the command on this
// host, with a run directory and a state folder of its own.
#pragma once

#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {

class Hosts : public RunCommand {
 protected:
  Hosts() {
    there_ = dir_ / "there";
    fs::create_directory(there_);
    ssh("");
    environment_["CONSTRICTOR_SSH"] = (dir_ / "ssh").string();
    environment_["XDG_RUNTIME_DIR"] = (dir_ / "here").string();
    fs::create_directory(dir_ / "here");
    patience(20);
  }
  /// Writes the script in place of ssh, which first executes `commands`.
  void ssh(const std::string& commands) const {
    write("ssh", "#!/bin/sh\n" + commands + "\nfor last; do :; done\nexport XDG_RUNTIME_DIR=" + there_.string() +
                     " XDG_STATE_HOME=" + state().string() +
                     "\nunset CONSTRICTOR_LAUNCHER CONSTRICTOR_SECURITY\nexec sh -c \"$last\"\n");
    fs::permissions(dir_ / "ssh", fs::perms::owner_all);
  }
  /// The folder in which the other host keeps what a run that is not over has written.
  [[nodiscard]] fs::path state() const { return there_ / "state"; }
  /// Writes hosts.yaml: navigation, control and report run on the host `robot`.
  void hosts(const std::string& keys, int patience_s) const {
    std::string manifest = replaced(kManifest, "patience_s: 4", "patience_s: " + std::to_string(patience_s));
    for (const char* name : {"navigation", "control", "report"}) {
      const std::string entry = std::string("[") + name + "], program: toy_host";
      manifest = replaced(manifest, entry, entry + ", host: robot");
    }
    write("hosts.yaml", manifest + "hosts: {here: local, robot: {ssh: snake@10.0.0.2, " + keys + "}}\n");
  }
  void patience(int seconds) const { hosts("directory: " + bin_.string(), seconds); }
  [[nodiscard]] Process run_there(long ticks, const std::string& report, std::vector<std::string> more = {}) const {
    return run(ticks, report, std::move(more), "hosts.yaml");
  }
  /// The pid of the agent; 0: there is none.
  [[nodiscard]] pid_t agent() const {
    for (const auto& [pid, line] : command_lines()) {
      if (line.find("agent") == std::string::npos || line.find("--token") == std::string::npos) continue;
      std::ifstream file("/proc/" + std::to_string(pid) + "/environ");
      const std::string environment(std::istreambuf_iterator<char>(file), {});
      if (environment.find(there_.string()) != std::string::npos && ::getsid(pid) == pid) return pid;
    }
    return 0;
  }
  /// Sends a signal to all processes of this test's runs on both hosts, their launcher and what connects them included.
  void signal_all(int number) const {
    for (const auto& [pid, line] : command_lines()) {
      std::ifstream file("/proc/" + std::to_string(pid) + "/environ");
      const std::string environment(std::istreambuf_iterator<char>(file), {});
      if (environment.find(dir_.string()) != std::string::npos) ::kill(pid, number);
    }
  }
  static std::string line_of_status(pid_t pid, const std::string& key) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with(key)) return line.substr(key.size());
    }
    return "";
  }
  void expect_nothing_left() const {
    expect_nothing_runs();
    EXPECT_TRUE(fs::is_empty(state() / "constrictor")) << fs::directory_iterator(state() / "constrictor")->path();
  }
  /// No process, and no file with a token or a key.
  void expect_nothing_runs() const {
    expect_nobody_left();
    EXPECT_TRUE(eventually([&] { return agent() == 0; })) << "an agent is left";
    for (const auto& entry : fs::directory_iterator(there_ / "constrictor"))
      EXPECT_TRUE(entry.path().extension() == ".lock") << entry.path() << " is left";
  }

  const fs::path bin_ = fs::path(program("constrictor")).parent_path();
  fs::path there_;
};

}  // namespace constrictor::testing
