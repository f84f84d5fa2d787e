// The scripts that divide an evaluation among hosts: GNU parallel over a real ssh connection, and a Slurm cluster of
// one node. Both on the loopback interface, with daemons, keys and ports of their own. Packages: scripts/setup.sh
// cluster.
#include <netinet/in.h>
#include <sys/socket.h>

#include "integration/run_command_fixture.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

/// A free TCP port of the loopback interface.
int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  ::close(socket);
  return ntohs(address.sin_port);
}

class EvaluationScripts : public RunCommand {
 protected:
  void SetUp() override { write("60_ticks.yaml", ""); }

  [[nodiscard]] static Process start(const std::string& program, std::vector<std::string> arguments,
                                     const std::map<std::string, std::string>& environment = {}) {
    arguments.insert(arguments.begin(), program);
    return Process(arguments, environment);
  }
  /// The command line of a script with the arguments of an evaluation of five short runs.
  [[nodiscard]] Process evaluate(const std::string& script, std::vector<std::string> options,
                                 const std::map<std::string, std::string>& environment = {}) const {
    for (const std::string& word :
         {std::string("--command"), program("constrictor"), std::string("--output"), (dir_ / "e").string(),
          std::string("--parts"), std::string("3"), std::string("--"), (dir_ / "60_ticks.yaml").string(),
          std::string("--manifest"), (dir_ / "toys.yaml").string(), std::string("--seeds"), std::string("1..5")})
      options.push_back(word);
    return start(testing::source_path("scripts/" + script), options, environment);
  }
  [[nodiscard]] std::set<std::string> runs() const {
    std::set<std::string> found;
    if (!fs::exists(dir_ / "e/whole/runs/as_given")) return found;
    for (const auto& run : fs::directory_iterator(dir_ / "e/whole/runs/as_given"))
      if (fs::exists(run.path() / "outcome.json")) found.insert(run.path().filename());
    return found;
  }
  const std::set<std::string> all_{"seed_0001", "seed_0002", "seed_0003", "seed_0004", "seed_0005"};
};

TEST_F(EvaluationScripts, PartsRunOnThisHostAndOverSsh) {
  for (const char* key : {"host", "user"}) {
    Process keygen = start("/usr/bin/ssh-keygen", {"-q", "-t", "ed25519", "-N", "", "-f", (dir_ / key).string()});
    ASSERT_EQ(keygen.wait(30s), 0) << keygen.errors();
  }
  const int port = free_port();
  const std::string folder = dir_.string();
  write("sshd", "Port " + std::to_string(port) + "\nListenAddress 127.0.0.1\nHostKey " + folder +
                    "/host\nAuthorizedKeysFile " + folder + "/user.pub\nStrictModes no\nPidFile none\n");
  fs::create_directories("/run/sshd");
  Process sshd = start("/usr/sbin/sshd", {"-D", "-e", "-f", (dir_ / "sshd").string()});
  ASSERT_TRUE(sshd.wait_for("Server listening", 20s)) << sshd.errors();
  const std::string ssh = "ssh -p " + std::to_string(port) + " -i " + folder +
                          "/user -o StrictHostKeyChecking=no -o LogLevel=ERROR -o UserKnownHostsFile=" + folder +
                          "/known_hosts";
  // Over ssh there is none of this test's environment, so that the runs there use the build's own files.
  Process script = evaluate("evaluate_on_hosts.sh", {"--hosts", ":,127.0.0.1", "--ssh", ssh});
  ASSERT_EQ(script.wait(120s), 0) << script.output() << script.errors();
  EXPECT_EQ(runs(), all_) << script.output() << script.errors();
  std::ifstream log(dir_ / "e/parts/jobs.log");
  const std::string jobs{std::istreambuf_iterator<char>(log), {}};
  EXPECT_NE(jobs.find("\t127.0.0.1\t"), std::string::npos) << "no part was done over ssh:\n" << jobs;
  EXPECT_NE(jobs.find("\t:\t"), std::string::npos) << "no part was done here:\n" << jobs;

  // The same command does nothing twice; a host that is gone is named, and the parts of others stay.
  sshd.signal(SIGTERM);
  ASSERT_TRUE(sshd.wait(20s));
  Process again = evaluate("evaluate_on_hosts.sh", {"--hosts", "127.0.0.1", "--ssh", ssh});
  ASSERT_EQ(again.wait(60s), 0) << again.errors();
  fs::remove_all(dir_ / "e/parts/results/1/2");
  Process gone = evaluate("evaluate_on_hosts.sh", {"--hosts", "127.0.0.1", "--ssh", ssh});
  EXPECT_EQ(gone.wait(60s), 1);
  EXPECT_NE(gone.errors().find("parts are missing"), std::string::npos) << gone.errors();
  EXPECT_EQ(runs(), all_);
}

TEST_F(EvaluationScripts, RefuseWhatTheyCannotDo) {
  Process no_hosts = start(testing::source_path("scripts/evaluate_on_hosts.sh"), {"--", "short"});
  EXPECT_EQ(no_hosts.wait(20s), exit_status::kUsage);
  EXPECT_NE(no_hosts.errors().find("--hosts and --output are needed"), std::string::npos);
  Process no_arguments = start(testing::source_path("scripts/evaluate_slurm.sh"), {"--output", "/tmp/none"});
  EXPECT_EQ(no_arguments.wait(20s), exit_status::kUsage);
  EXPECT_NE(no_arguments.errors().find("are missing after --"), std::string::npos);
  Process shard = start(testing::source_path("scripts/evaluate_slurm.sh"),
                        {"--output", (dir_ / "e").string(), "--", "short", "--shard", "1/2"});
  EXPECT_EQ(shard.wait(20s), exit_status::kUsage);
  EXPECT_NE(shard.errors().find("--shard belongs to this script"), std::string::npos);
}

TEST_F(EvaluationScripts, PartsRunAsAnArrayOfSlurm) {
  const std::string folder = dir_.string();
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  const std::string name = std::string(host.data()).substr(0, std::string(host.data()).find('.'));
  write("munge.key", std::string(1024, 'k'));
  ASSERT_EQ(::chmod((dir_ / "munge.key").c_str(), 0600), 0);
  for (const char* part : {"state", "spool"}) fs::create_directories(dir_ / part);
  const std::string conf = (dir_ / "slurm.conf").string();
  write("slurm.conf",
        "ClusterName=test\nSlurmctldHost=" + name + "(127.0.0.1)\nAuthType=auth/munge\nAuthInfo=socket=" + folder +
            "/munge.socket\nSlurmUser=root\nSlurmdUser=root\nStateSaveLocation=" + folder +
            "/state\nSlurmdSpoolDir=" + folder + "/spool\nSlurmctldPidFile=" + folder +
            "/ctld.pid\nSlurmdPidFile=" + folder + "/slurmd.pid\nProctrackType=proctrack/linuxproc\n" +
            "TaskPlugin=task/none\nReturnToService=2\nMpiDefault=none\nSlurmctldPort=" + std::to_string(free_port()) +
            "\nSlurmdPort=" + std::to_string(free_port()) + "\nNodeName=" + name +
            " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n" + "PartitionName=all Nodes=ALL Default=YES State=UP\n");
  const std::map<std::string, std::string> environment{{"SLURM_CONF", conf}};
  const auto in_folder = [&](const char* file) { return "=" + folder + "/" + file; };
  Process munge = start("/usr/sbin/munged", {"--foreground", "--force", "--key-file" + in_folder("munge.key"),
                                             "--socket" + in_folder("munge.socket"), "--pid-file" + in_folder("m.pid"),
                                             "--seed-file" + in_folder("munge.seed")});
  ASSERT_TRUE(eventually([&] { return fs::exists(dir_ / "munge.socket"); })) << munge.errors();
  Process controller = start("/usr/sbin/slurmctld", {"-D", "-f", conf}, environment);
  Process node = start("/usr/sbin/slurmd", {"-D", "-f", conf}, environment);
  ASSERT_TRUE(eventually([&] {
    Process info = start("/usr/bin/sinfo", {"-h", "-o", "%T"}, environment);
    return info.wait(20s) == 0 && info.output().find("idle") == 0;
  })) << controller.errors()
      << node.errors();
  Process script = evaluate("evaluate_slurm.sh", {"--wait"}, environment);
  EXPECT_EQ(script.wait(180s), 0) << script.output() << script.errors();
  EXPECT_EQ(runs(), all_) << script.output() << script.errors();
  for (Process* daemon : {&node, &controller, &munge}) {
    daemon->signal(SIGTERM);
    EXPECT_TRUE(daemon->wait(30s));
  }
}

}  // namespace
}  // namespace constrictor::testing
