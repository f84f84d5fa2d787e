#include "cli/remote/agent.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "cli/launch_plan.hpp"
#include "cli/remote/host_description.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kAgentPoll = 50ms;
constexpr auto kStateEvery = 1s;
constexpr auto kGoneAfter = 10s;   // a closed connection without a new one: the launcher has died
constexpr auto kTermination = 3s;  // from SIGTERM to SIGKILL

[[noreturn]] void fail(const std::string& what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

Agent::Agent(const std::string& token) : folder_(agent_folder(token)) {
  remove_stale_agents(folder_);
  if (::mkdir(folder_.c_str(), 0700) != 0 && errno != EEXIST) fail(folder_.string());
  lock_ = Descriptor(::open((folder_ / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600));
  if (!lock_.open() || ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) fail((folder_ / "lock").string());
  make_folders();
  listener_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (folder_ / "socket").string();
  if (path.size() >= sizeof(address.sun_path)) throw std::runtime_error("the path is too long for a socket: " + path);
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      ::listen(listener_.get(), 4) != 0)
    fail(path);
  sigset_t set;
  ::sigemptyset(&set);
  for (const int number : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&set, number);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  signals_ = Descriptor(::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
  disconnected_at_ = awake_.now();
}

Agent::~Agent() { clean_up(); }

int Agent::run() {
  while (!over_ && !abandoned()) {
    std::array<pollfd, 4> waits{pollfd{listener_.get(), POLLIN, 0}, pollfd{signals_.get(), POLLIN, 0},
                                pollfd{echo_.get(), POLLIN, 0},
                                pollfd{channel_ ? channel_->descriptor() : -1, POLLIN, 0}};
    ::poll(waits.data(), waits.size(), static_cast<int>(kAgentPoll.count()));
    for (signalfd_siginfo info{}; ::read(signals_.get(), &info, sizeof(info)) == sizeof(info);) {
      if (info.ssi_signo != SIGCHLD) over_ = true;
    }
    accept_connection();
    answer_echo();
    probe();
    const bool ended = reap();
    for (auto& [name, process] : processes_) bound_log_of(name, process);
    if (!channel_) continue;
    try {
      channel_->exchange();
      while (auto message = channel_->receive()) take(*message);
    } catch (const std::exception& error) {
      channel_->send({{"op", "error"}, {"text", error.what()}});
    }
    if (greeted_) {
      send_logs();
      send_files();
      if (ended || Clock::now() - last_state_ > kStateEvery) send_state();
    }
    channel_->exchange();
    if (channel_->closed()) {
      channel_.reset();
      disconnected_at_ = awake_.now();
    }
  }
  clean_up();
  if (channel_ && over_) {
    channel_->send({{"op", "ended"}});
    for (int i = 0; i < 100 && channel_->unsent() > 0 && !channel_->closed(); ++i) {
      channel_->exchange();
      std::this_thread::sleep_for(10ms);
    }
  }
  return exit_status::kOk;
}

void Agent::accept_connection() {
  const int connection = ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) return;
  // The newest connection counts: the launcher gave the older one up.
  channel_ = std::make_unique<MessageChannel>(Descriptor(connection));
  disconnected_at_.reset();
  collecting_ = greeted_ = false;
}

bool Agent::abandoned() {
  const auto now = awake_.now();
  return now - last_word_ > patience_ ||
         (disconnected_at_ && now - *disconnected_at_ > std::min<std::chrono::duration<double>>(kGoneAfter, patience_));
}

void Agent::take(const nlohmann::json& message) {
  last_word_ = awake_.now();
  const auto op = field<std::string>(message, "op");
  if (op == "hello") take_hello(message);
  else if (op == "prepare") prepare(message);
  else if (op == "start") start(message);
  else if (op == "signal") signal(message);
  else if (op == "collect") collect();
  else if (op == "echo") open_echo(message);
  else if (op == "probe") open_probe(message);
  else if (op == "end") over_ = true, keep_ = field<bool>(message, "keep");
  else if (op == "ping") last_state_ = {};
  else
    throw ProtocolError("found op \"" + op +
                        "\", accepted hello, prepare, start, signal, collect, echo, probe, end, "
                        "ping");
}

void Agent::take_hello(const nlohmann::json& message) {
  if (field<int>(message, "protocol") != kAgentProtocol)
    throw ProtocolError(fmt::format("protocol: found {}, accepted {}; both hosts need the same release",
                                    message["protocol"].dump(), kAgentProtocol));
  const auto patience_s = field<double>(message, "patience_s");
  if (!(patience_s >= 1 && patience_s <= 86400)) throw ProtocolError("patience_s: accepted 1 to 86400");
  patience_ = std::chrono::duration<double>(patience_s);
  const auto sender = field<std::string>(message, "launcher");
  if (!launcher_.empty() && sender != launcher_) start_over();
  launcher_ = sender;
  keep_ = keep_ || field<bool>(message, "resume");
  for (const auto& [name, offset] : field<std::map<std::string, std::uintmax_t>>(message, "logs"))
    processes_[name].log_sent = offset;
  HostPlan plan;
  plan.interface = field<std::string>(message, "interface");
  plan.address = field<std::string>(message, "address");
  if (description_.is_null()) description_ = describe_this_host();
  nlohmann::json answer = description_;
  answer["op"] = "hello";
  answer["folder"] = folder_.string();
  answer["kept"] = kept_output(folder_).string();
  answer["pid"] = ::getpid();
  answer["prepared"] = prepared_;
  // sshd's variable names both ends of the connection: address and port of the launcher, then those of this host.
  std::istringstream ends(std::getenv("SSH_CONNECTION") ? std::getenv("SSH_CONNECTION") : "");
  std::string launcher, port, own;
  ends >> launcher >> port >> own;
  answer["launcher_ip"] = launcher;
  answer["ip"] = field<std::string>(message, "network") == answer["network"] ? "" : own_address(plan, own);
  channel_->send(answer);
  greeted_ = true;
  send_state();
}

void Agent::start(const nlohmann::json& message) {
  const auto name = field<std::string>(message, "name");
  const auto incarnation = field<std::uint32_t>(message, "incarnation");
  const auto program = field<std::string>(message, "program");
  if (!is_plain_name(name)) throw ProtocolError("name: found \"" + name + "\", accepted " + kPlainName);
  if (!prepared_) throw ProtocolError("start: accepted only after prepare");
  Managed& process = processes_[name];
  if (incarnation <= process.incarnation) return;                           // a repeated request
  std::vector<std::string> argv = {(program_folder() / program).string()};  // an absolute path stays as it is
  for (auto& argument : field<std::vector<std::string>>(message, "arguments")) argv.push_back(std::move(argument));
  const std::vector<std::string> environment = run_environment();
  auto more = field<std::vector<std::string>>(message, "environment");
  // First, so that keys that the manifest names take precedence.
  if (fs::exists(folder_ / "keys")) more.insert(more.begin(), "CONSTRICTOR_SECURITY=" + (folder_ / "keys").string());
  if (!dds_xml_.empty()) more.push_back("CYCLONEDDS_URI=" + dds_xml_);
  process.child = std::make_unique<ChildProcess>(argv, with_variables(environment, more), log_of(name));
  process.incarnation = incarnation;
  last_state_ = {};
}

void Agent::signal(const nlohmann::json& message) {
  const auto process = processes_.find(field<std::string>(message, "name"));
  const auto number = field<int>(message, "number");
  if (number <= 0 || number > 64) throw ProtocolError("number: accepted a signal, 1 to 64");
  if (process == processes_.end() || !process->second.child) return;
  if (process->second.incarnation == field<std::uint32_t>(message, "incarnation"))
    process->second.child->signal(number);
}

bool Agent::reap() {
  bool ended = false;
  for (auto& [name, process] : processes_) {
    if (process.child && process.child->running() && process.child->poll()) ended = true;
  }
  return ended;
}

void Agent::kill_all(bool at_once) {
  const auto running = [this] {
    reap();
    for (const auto& [name, process] : processes_) {
      if (process.child && process.child->running()) return true;
    }
    return false;
  };
  const auto signal_all = [this](int number) {
    for (const auto& [name, process] : processes_) {
      if (process.child) process.child->signal(number);
    }
  };
  const auto begin = Clock::now();
  if (!at_once) signal_all(SIGTERM);
  signal_all(SIGCONT);
  while (!at_once && running() && Clock::now() - begin < kTermination) std::this_thread::sleep_for(10ms);
  signal_all(SIGKILL);
  while (running()) std::this_thread::sleep_for(1ms);
}

}  // namespace constrictor::cli
