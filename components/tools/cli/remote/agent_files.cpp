// The files of the agent: those that it receives for the run, and what is kept of those that its processes write.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "cli/remote/agent.hpp"
#include "cli/run_record.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kMakingBound = 60s;  // an agent's folder this young may not be locked yet
constexpr auto kKeptFor = 7 * 24h;  // the output of the processes of an interrupted run
constexpr const char* kAgent = "agent-";
constexpr const char* kKept = "run-";

/// The folder in which output is kept until its run is over: unlike the run directory, this folder survives a reboot
/// and the end of the user's last login. Empty: the user has no such folder.
fs::path state_directory() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (state && *state) folder = state;
  else if (home && *home) folder = fs::path(home) / ".local/state";
  if (folder.empty()) return {};
  std::error_code error;
  fs::create_directories(folder / "constrictor", error);
  return error ? fs::path() : folder / "constrictor";
}

/// Removes the output that was kept of runs that were not continued.
void remove_stale_output(const fs::path& own) {
  const fs::path state = state_directory(), spared = kept_output(own);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(state, ignored)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(kKept) || entry.path() == spared) continue;
    if (fs::exists(own.parent_path() / (kAgent + name.substr(std::string(kKept).size())))) continue;
    auto newest = fs::last_write_time(entry.path(), ignored);
    for (const auto& file : fs::recursive_directory_iterator(entry.path(), ignored))
      newest = std::max(newest, fs::last_write_time(file.path(), ignored));
    if (fs::file_time_type::clock::now() - newest > kKeptFor) fs::remove_all(entry.path(), ignored);
  }
}

/// Writes a file that only this user can read, from its first byte on.
void write_private(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  const Descriptor file(::open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0600));
  for (std::size_t written = 0; written < text.size() || !file.open();) {
    const ssize_t count = file.open() ? ::write(file.get(), text.data() + written, text.size() - written) : -1;
    if (count <= 0) throw std::runtime_error("cannot write " + path.string());
    written += static_cast<std::size_t>(count);
  }
}

}  // namespace

fs::path kept_output(const fs::path& agent) {
  const fs::path state = state_directory();
  return state.empty() ? state : state / (kKept + agent.filename().string().substr(std::string(kAgent).size()));
}

fs::path agent_folder(const std::string& token) { return run_directory() / (kAgent + token); }

void remove_stale_agents(const fs::path& own) {
  for (const auto& entry : fs::directory_iterator(run_directory())) {
    if (!entry.path().filename().string().starts_with(kAgent)) continue;
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
  remove_stale_output(own);
}

void Agent::make_folders() {
  for (const char* name : {"files", "logs"}) fs::create_directory(folder_ / name);
  std::error_code error;
  const fs::path kept = kept_output(folder_), output = folder_ / "output";
  if (!kept.empty() && (fs::create_directory(kept, error), !error)) {
    fs::permissions(kept, fs::perms::owner_all, error);
    if (!fs::exists(output)) fs::create_directory_symlink(kept, output, error);
  }
  fs::create_directory(output, error);  // where a user has no place that lasts, a run cannot be continued later
  if (!fs::is_directory(output)) throw std::runtime_error("cannot make the folder " + output.string());
}

void Agent::start_over() {
  kill_all(true);
  processes_.clear();
  files_to_send_.clear();
  security_.reset();
  dds_ = {};
  claim_.reset();
  prepared_ = collecting_ = false;
  description_ = nullptr;
  for (const char* name : {"files", "keys", "logs"}) fs::remove_all(folder_ / name);
  make_folders();
}

void Agent::clean_up() {
  // Once only: when the launcher knows that the agent has ended, an agent that it starts anew uses the same folder.
  if (std::exchange(cleaned_up_, true)) return;
  kill_all(keep_);
  security_.reset();
  std::error_code ignored;
  const fs::path kept = kept_output(folder_);
  if (!keep_ && !kept.empty()) fs::remove_all(kept, ignored);
  // The folder is renamed first: another agent may make a folder of the same name while this one is removed.
  const fs::path leaving = folder_.string() + ".ended";
  fs::remove_all(leaving, ignored);
  std::error_code error;
  fs::rename(folder_, leaving, error);
  fs::remove_all(error ? folder_ : leaving, ignored);
  dds_ = {};
  claim_.reset();
}

void Agent::prepare(const nlohmann::json& message) {
  dds_xml_ = field<std::string>(message, "dds");
  const auto domain = field<std::uint32_t>(message, "domain");
  if (field<bool>(message, "claim") && !claim_) {
    claim_ = std::make_unique<DomainClaim>(domain);
    dds_ = PublishedDdsConfiguration(domain, dds_xml_);
  }
  store_files(message);
  store_keys(message);
  if (claim_ && fs::exists(folder_ / "keys"))
    security_ = std::make_unique<dds::PublishedSecurity>(domain, folder_ / "keys");
  if (field<bool>(message, "resume")) continued_ = prepare_checkpoint(folder_ / "output");
  keep_ = field<bool>(message, "keep");
  prepared_ = true;
  channel_->send({{"op", "prepared"}, {"continued", continued_}});
}

void Agent::store_files(const nlohmann::json& message) {
  for (const auto& file : field<std::vector<nlohmann::json>>(message, "files")) {
    const auto number = field<unsigned>(file, "number");
    const auto name = field<std::string>(file, "name");
    if (!is_plain_name(name)) throw ProtocolError("files: found the name \"" + name + "\", accepted a file name");
    // One of the files has the token of the run.
    write_private(folder_ / "files" / std::to_string(number) / name, field<std::string>(file, "text"));
  }
}

void Agent::store_keys(const nlohmann::json& message) {
  const auto keys = field<std::map<std::string, std::string>>(message, "keys");
  for (const auto& [path, text] : keys) {
    if (!is_plain_path(path)) throw ProtocolError("keys: found the path \"" + path + "\", accepted a relative path");
    write_private(folder_ / "keys" / path, text);
  }
  for (const auto& identity : field<std::vector<std::string>>(message, "identities")) {
    if (!is_plain_name(identity)) throw ProtocolError("identities: found \"" + identity + "\", accepted " + kPlainName);
    const std::string problem = dds::problem_of_identity(folder_ / "keys", identity);
    if (!problem.empty()) throw std::runtime_error("DDS Security: " + problem);
  }
}

}  // namespace constrictor::cli
