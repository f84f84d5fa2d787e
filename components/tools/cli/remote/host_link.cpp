#include "cli/remote/host_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <random>

#include "cli/remote/host_description.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kPing = 1s;
constexpr auto kSilent = 5s;         // without a word, the connection counts as broken
constexpr auto kAttemptBound = 20s;  // for a new connection, from the start of ssh to the agent's answer
constexpr auto kFirstPause = 250ms;  // between two attempts; doubled after each
constexpr auto kLongestPause = 8000ms;

/// Whether an attempt to connect that ended with this error would end in the same way again.
bool is_final(const std::string& error) {
  if (error.find("Temporary failure in name resolution") != std::string::npos) return false;
  for (const char* text : {"Permission denied", "Host key verification failed", "REMOTE HOST IDENTIFICATION",
                           "cannot start ssh", "Bad configuration", "Could not resolve hostname"}) {
    if (error.find(text) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

HostLink::HostLink(std::string name, HostPlan plan, std::string token, double patience_s, Print print, bool resume)
    : name_(std::move(name)),
      plan_(std::move(plan)),
      token_(std::move(token)),
      patience_(patience_s),
      print_(std::move(print)),
      resume_(resume) {
  std::random_device entropy;
  launcher_ = fmt::format("{:08x}{:08x}", entropy(), entropy());
}

HostLink::~HostLink() = default;

void HostLink::refuse(const std::string& reason) const {
  throw HostError(fmt::format("host {} ({}): {}", name_, plan_.ssh, reason));
}

void HostLink::exchange() {
  if (ended_ || lost_) return;
  try {
    if (connection_) {
      connection_->channel().exchange();
      while (connection_) {
        const auto message = connection_->channel().receive();
        if (!message) break;
        take(*message);
      }
      if (connection_ && up_ && connection_->channel().closed()) {
        go_away(connection_->ended() ? connection_->last_error() : "the connection was closed");
        connection_.reset();
      }
    }
    if (up_ && awake_.now() - last_word_ > kSilent)
      go_away(fmt::format("no answer for {} s", std::chrono::seconds(kSilent).count()));
    if (up_ && awake_.now() - last_ping_ > kPing) {
      last_ping_ = awake_.now();
      send({{"op", "ping"}});
    }
    if (!up_ && !ended_) connect();
  } catch (const ProtocolError& error) {
    if (!prepared_) refuse(error.what());
    give_up(error.what());
  } catch (const HostError& error) {
    if (!prepared_) throw;
    give_up(error.what());
  }
  if (up_ || ended_ || awake_.now() - away_since_ < patience_) return;
  const std::string reason = fmt::format("could not be reached for {:.0f} s: {}", patience_.count(),
                                         last_error_.empty() ? "ssh has not connected yet" : last_error_);
  if (!prepared_) refuse(reason);
  give_up(reason);
}

void HostLink::give_up(const std::string& reason) {
  lost_ = true;
  up_ = false;
  connection_.reset();
  next_.reset();
  print_(fmt::format("host {}: {}", name_, reason));
  for (auto& [process, state] : processes_) state.lost = true;
}

void HostLink::go_away(const std::string& why) {
  if (!up_) return;
  up_ = false;
  if (ending_) ended_ = true;
  away_since_ = last_word_;
  last_error_ = why;
  pause_ = kFirstPause;
  next_attempt_ = awake_.now();
  away_printed_ = false;
}

void HostLink::connect() {
  const auto now = awake_.now();
  if (next_) return read_new_connection();
  if (now < next_attempt_) return;
  next_ = std::make_unique<SshConnection>(plan_, token_, begun_);
  attempt_began_ = now;
  say_hello(*next_);
}

void HostLink::say_hello(SshConnection& connection) {
  nlohmann::json logs = nlohmann::json::object();
  for (const auto& [process, state] : processes_) logs[process] = state.received;
  connection.channel().send({{"op", "hello"},
                             {"protocol", kAgentProtocol},
                             {"launcher", launcher_},
                             {"resume", resume_},
                             {"patience_s", patience_.count()},
                             {"interface", plan_.interface},
                             {"address", plan_.address},
                             {"network", this_network()},
                             {"logs", logs}});
}

void HostLink::read_new_connection() {
  next_->channel().exchange();
  if (const auto message = next_->channel().receive()) {
    // A new connection works: the silent one before it is not needed any more.
    connection_ = std::move(next_);
    return take(*message);
  }
  const bool ended = next_->channel().closed() && next_->ended();
  if (!ended && awake_.now() - attempt_began_ < kAttemptBound) return;
  last_error_ = ended ? next_->last_error() : "ssh did not connect in time";
  next_.reset();
  if (!prepared_ && is_final(last_error_))
    refuse(last_error_ + "; `ssh " + plan_.ssh + "` must work without a question");
  next_attempt_ = awake_.now() + pause_;
  pause_ = std::min<std::chrono::milliseconds>(2 * pause_, kLongestPause);
  if (std::exchange(away_printed_, true)) return;
  print_(fmt::format("host {} cannot be reached: {}; trying again for up to {:.0f} s", name_, last_error_,
                     patience_.count()));
}

void HostLink::send(const nlohmann::json& message) {
  if (up_ && connection_) connection_->channel().send(message);
}

void HostLink::take(const nlohmann::json& message) {
  last_word_ = awake_.now();
  const auto op = field<std::string>(message, "op");
  if (op == "hello") take_hello(message);
  else if (op == "state") take_state(message);
  else if (op == "log") take_log(message);
  else if (op == "file") take_file(message);
  else if (op == "prepared") prepared_ = true, continued_ = field<std::string>(message, "continued");
  else if (op == "collected") collecting_ = false, collected_ = true;
  else if (op == "ended") ended_ = true;
  else if (op == "echoing") echo_answer_ = message;
  else if (op == "probed") probe_answer_ = message;
  else if (op == "gone") agent_is_gone();
  else if (op == "error") refuse(field<std::string>(message, "text"));
  else if (op == "no release")
    refuse(
        fmt::format("found no constrictor of release {}, but:{} install this release there, or name its directory "
                    "in the manifest (key directory)",
                    kVersion, message.value("text", "").empty() ? " none;" : message.value("text", "")));
  else throw ProtocolError("found op \"" + op + "\", which this release does not know");
}

void HostLink::take_hello(const nlohmann::json& message) {
  if (begun_ && away_printed_)
    print_(fmt::format("host {} is reached again after {:.0f} s", name_,
                       std::chrono::duration<double>(awake_.now() - away_since_).count()));
  description_ = message;
  begun_ = up_ = true;
  away_printed_ = false;
  pause_ = kFirstPause;
  resend();
}

void HostLink::resend() {
  if (ending_) return send({{"op", "end"}, {"keep", keep_}});
  if (!preparation_.is_null() && !description_.value("prepared", false)) send(preparation_);
  for (const auto& [process, state] : processes_) {
    if (state.exit) continue;
    send(state.request);  // the agent ignores it if it has started the process
    if (state.wanted_signal != 0)
      send({{"op", "signal"}, {"name", process}, {"incarnation", state.incarnation}, {"number", state.wanted_signal}});
  }
  if (collecting_) send({{"op", "collect"}});
}

void HostLink::agent_is_gone() {
  connection_.reset();
  begun_ = false;
  print_(fmt::format("host {}: its agent has ended, and all its processes with it; it is started again", name_));
  for (auto& [process, state] : processes_) {
    state.received = 0;
    if (!state.exit) state.exit = ChildExit{SIGKILL, 0};
  }
  if (ending_) ended_ = true;
  next_attempt_ = awake_.now();
}

void HostLink::prepare(const nlohmann::json& request) {
  preparation_ = request;
  send(request);
}

void HostLink::start(const std::string& process, std::uint32_t incarnation, nlohmann::json request,
                     const std::filesystem::path& log) {
  const std::uintmax_t received = processes_[process].received;
  processes_[process] = {incarnation, std::move(request), false, lost_, 0, 0, 0, std::nullopt, log, received};
  send(processes_[process].request);
}

void HostLink::signal(const std::string& process, int number) {
  Process& state = processes_.at(process);
  if (state.exit) return;
  if (number == SIGTERM || number == SIGKILL) state.wanted_signal = number;
  send({{"op", "signal"}, {"name", process}, {"incarnation", state.incarnation}, {"number", number}});
}

void HostLink::take_state(const nlohmann::json& message) {
  for (const auto& entry : field<std::vector<nlohmann::json>>(message, "processes")) {
    const auto found = processes_.find(field<std::string>(entry, "name"));
    if (found == processes_.end() || found->second.incarnation != field<std::uint32_t>(entry, "incarnation")) continue;
    Process& process = found->second;
    process.started = true;
    process.pid = field<pid_t>(entry, "pid");
    process.pss_mib = field<double>(entry, "pss_mib");
    if (entry.contains("wait_status") && !process.exit)
      process.exit = ChildExit{field<int>(entry, "wait_status"), field<double>(entry, "cpu_s")};
  }
}

void HostLink::end(bool keep) {
  ending_ = true;
  keep_ = keep;
  if (up_) return send({{"op", "end"}, {"keep", keep}});
  if (!begun_) ended_ = true;
}

}  // namespace constrictor::cli
