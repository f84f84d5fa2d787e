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
constexpr auto kGoneAfter = 10s;    // a closed connection without a new one: the launcher has died
constexpr auto kTermination = 3s;   // from SIGTERM to SIGKILL
constexpr auto kMakingBound = 60s;  // an agent's folder this young may not be locked yet

[[noreturn]] void fail(const std::string& what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

fs::path agent_folder(const std::string& token) { return run_directory() / ("agent-" + token); }

void remove_stale_agents(const fs::path& own) {
  for (const auto& entry : fs::directory_iterator(run_directory())) {
    if (!entry.path().filename().string().starts_with("agent-")) continue;
    std::error_code ignored;
    const bool young = fs::file_time_type::clock::now() - fs::last_write_time(entry.path(), ignored) < kMakingBound;
    if (young && entry.path() != own) continue;
    const Descriptor lock(::open((entry.path() / "lock").c_str(), O_RDWR | O_CLOEXEC));
    if (lock.open() && ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) continue;
    // A run that goes on continues from what its processes have written, for example from the plant's checkpoint.
    for (const auto& part : fs::directory_iterator(entry.path())) {
      if (entry.path() != own || part.path().filename() != "output") fs::remove_all(part.path(), ignored);
    }
    if (entry.path() != own) fs::remove(entry.path(), ignored);
  }
}

Agent::Agent(const std::string& token) : folder_(agent_folder(token)) {
  remove_stale_agents(folder_);
  if (::mkdir(folder_.c_str(), 0700) != 0 && errno != EEXIST) fail(folder_.string());
  lock_ = Descriptor(::open((folder_ / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600));
  if (!lock_.open() || ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) fail((folder_ / "lock").string());
  for (const char* name : {"files", "logs", "output"}) fs::create_directory(folder_ / name);
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
  disconnected_at_ = Clock::now();
}

Agent::~Agent() { clean_up(); }

void Agent::clean_up() {
  kill_all();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  dds_ = {};
  claim_.reset();
}

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
    const bool ended = reap();
    for (auto& [name, process] : processes_) bound_log_of(name, process);
    if (!channel_) continue;
    try {
      channel_->exchange();
      while (auto message = channel_->receive()) take(*message);
    } catch (const std::exception& error) {
      channel_->send({{"op", "error"}, {"text", error.what()}});
    }
    send_logs();
    send_files();
    if (ended || Clock::now() - last_state_ > kStateEvery) send_state();
    channel_->exchange();
    if (channel_->closed()) {
      channel_.reset();
      disconnected_at_ = Clock::now();
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
  collecting_ = false;
}

bool Agent::abandoned() const {
  const auto now = Clock::now();
  return now - last_word_ > patience_ ||
         (disconnected_at_ && now - *disconnected_at_ > std::min<std::chrono::duration<double>>(kGoneAfter, patience_));
}

void Agent::take(const nlohmann::json& message) {
  last_word_ = Clock::now();
  const auto op = field<std::string>(message, "op");
  if (op == "hello") take_hello(message);
  else if (op == "prepare") prepare(message);
  else if (op == "start") start(message);
  else if (op == "signal") signal(message);
  else if (op == "collect") collect();
  else if (op == "echo") open_echo(message);
  else if (op == "end") over_ = true;
  else if (op == "ping") last_state_ = {};
  else throw ProtocolError("found op \"" + op + "\", accepted hello, prepare, start, signal, collect, echo, end, ping");
}

void Agent::take_hello(const nlohmann::json& message) {
  if (field<int>(message, "protocol") != kAgentProtocol)
    throw ProtocolError(fmt::format("protocol: found {}, accepted {}; both hosts need the same release",
                                    message["protocol"].dump(), kAgentProtocol));
  const auto patience_s = field<double>(message, "patience_s");
  if (!(patience_s >= 1 && patience_s <= 86400)) throw ProtocolError("patience_s: accepted 1 to 86400");
  patience_ = std::chrono::duration<double>(patience_s);
  for (const auto& [name, offset] : field<std::map<std::string, std::uintmax_t>>(message, "logs"))
    processes_[name].log_sent = offset;
  HostPlan plan;
  plan.interface = field<std::string>(message, "interface");
  plan.address = field<std::string>(message, "address");
  if (description_.is_null()) description_ = describe_this_host();
  nlohmann::json answer = description_;
  answer["op"] = "hello";
  answer["folder"] = folder_.string();
  answer["pid"] = ::getpid();
  answer["prepared"] = prepared_;
  // sshd's variable names both ends of the connection: address and port of the launcher, then those of this host.
  std::istringstream ends(std::getenv("SSH_CONNECTION") ? std::getenv("SSH_CONNECTION") : "");
  std::string launcher, port, own;
  ends >> launcher >> port >> own;
  answer["launcher_ip"] = launcher;
  answer["ip"] = field<std::string>(message, "network") == answer["network"] ? "" : own_address(plan, own);
  channel_->send(answer);
  send_state();
}

void Agent::prepare(const nlohmann::json& message) {
  dds_xml_ = field<std::string>(message, "dds");
  const auto domain = field<std::uint32_t>(message, "domain");
  if (field<bool>(message, "claim") && !claim_) {
    claim_ = std::make_unique<DomainClaim>(domain);
    dds_ = PublishedDdsConfiguration(domain, dds_xml_);
  }
  for (const auto& file : field<std::vector<nlohmann::json>>(message, "files")) {
    const auto number = field<unsigned>(file, "number");
    const auto name = field<std::string>(file, "name");
    if (!is_plain_name(name)) throw ProtocolError("files: found the name \"" + name + "\", accepted a file name");
    const fs::path path = folder_ / "files" / std::to_string(number) / name;
    fs::create_directories(path.parent_path());
    if (!(std::ofstream(path, std::ios::binary) << field<std::string>(file, "text")).flush())
      throw std::runtime_error("cannot write " + path.string());
    // One of the files has the token of the run.
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  }
  prepared_ = true;
  channel_->send({{"op", "prepared"}});
}

void Agent::start(const nlohmann::json& message) {
  const auto name = field<std::string>(message, "name");
  const auto incarnation = field<std::uint32_t>(message, "incarnation");
  const auto program = field<std::string>(message, "program");
  if (!is_plain_name(name)) throw ProtocolError("name: found \"" + name + "\", accepted a plain name");
  if (!prepared_) throw ProtocolError("start: accepted only after prepare");
  Managed& process = processes_[name];
  if (incarnation <= process.incarnation) return;                           // a repeated request
  std::vector<std::string> argv = {(program_folder() / program).string()};  // an absolute path stays as it is
  for (auto& argument : field<std::vector<std::string>>(message, "arguments")) argv.push_back(std::move(argument));
  std::vector<std::string> environment = run_environment();
  auto more = field<std::vector<std::string>>(message, "environment");
  if (!dds_xml_.empty()) more.push_back("CYCLONEDDS_URI=" + dds_xml_);
  for (const auto& variable : more) {
    const std::string variable_name = variable.substr(0, variable.find('=') + 1);
    std::erase_if(environment, [&](const std::string& other) { return other.starts_with(variable_name); });
    environment.push_back(variable);
  }
  process.child = std::make_unique<ChildProcess>(argv, environment, log_of(name));
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

void Agent::kill_all() {
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
  signal_all(SIGTERM);
  signal_all(SIGCONT);
  while (running() && Clock::now() - begin < kTermination) std::this_thread::sleep_for(10ms);
  signal_all(SIGKILL);
  while (running()) std::this_thread::sleep_for(1ms);
}

}  // namespace constrictor::cli
