// The reports of the agent to the launcher while processes run: their state, their logs, the files that they write.
#include <fmt/format.h>

#include <fstream>

#include "cli/log/log_files.hpp"
#include "cli/remote/agent.hpp"
#include "constrictor/hex.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kUnsentBound = 1 << 18;  // [byte] logs and files wait while more than this is unsent
constexpr std::size_t kChunk = 48 << 10;       // [byte] of a log or a file in one message

std::string read_chunk(const fs::path& path, std::uintmax_t offset) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kChunk, '\0');
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

std::uintmax_t size_of(const fs::path& path) {
  std::error_code missing;
  const auto size = fs::file_size(path, missing);
  return missing ? 0 : size;
}

std::string hexadecimal(const std::string& bytes) {
  return hex({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

std::uintmax_t Agent::log_size(const std::string& name, const Managed& process) const {
  return process.log_cut + size_of(log_of(name));
}

void Agent::bound_log_of(const std::string& name, Managed& process) const {
  const std::uintmax_t size = size_of(log_of(name));
  const bool sent = process.log_sent == process.log_cut + size;
  if (size <= (sent ? kMostLogBytes : 2 * kMostLogBytes)) return;
  std::error_code error;
  fs::resize_file(log_of(name), 0, error);
  if (!error) process.log_cut += size;
}

void Agent::send_logs() {
  for (auto& [name, process] : processes_) {
    if (process.log_sent < process.log_cut) {
      const auto text = fmt::format("{} bytes of the log were dropped: there was no connection\n",
                                    process.log_cut - process.log_sent);
      process.log_sent = process.log_cut;
      channel_->send({{"op", "log"}, {"name", name}, {"next", process.log_sent}, {"text", text}});
    }
    while (channel_->unsent() < kUnsentBound && process.log_sent < log_size(name, process)) {
      const std::string bytes = read_chunk(log_of(name), process.log_sent - process.log_cut);
      if (bytes.empty()) break;
      const auto end = bytes.rfind('\n');  // whole lines, so that no character is cut
      const std::string text = end == std::string::npos ? bytes : bytes.substr(0, end + 1);
      process.log_sent += text.size();
      channel_->send({{"op", "log"}, {"name", name}, {"next", process.log_sent}, {"text", text}});
    }
  }
}

void Agent::send_state() {
  last_state_ = Clock::now();
  nlohmann::json list = nlohmann::json::array();
  for (auto& [name, process] : processes_) {
    if (!process.child) continue;
    if (const double now = process.child->pss_mib(); now > 0) process.pss_mib = now;
    nlohmann::json entry = {{"name", name},
                            {"incarnation", process.incarnation},
                            {"pid", process.child->pid()},
                            {"pss_mib", process.pss_mib}};
    // The end is reported after the log, so that the launcher can show the last lines.
    const bool log_complete = process.log_sent >= log_size(name, process);
    if (const auto& exit = process.child->poll(); exit && log_complete) {
      entry["wait_status"] = exit->wait_status;
      entry["cpu_s"] = exit->cpu_s;
    }
    list.push_back(std::move(entry));
  }
  channel_->send({{"op", "state"}, {"processes", std::move(list)}});
}

void Agent::collect() {
  collecting_ = true;
  files_to_send_.clear();
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "output")) {
    const std::string path = fs::relative(entry.path(), folder_ / "output").string();
    // The plant's checkpoints stay here: a run is continued from this host's, and one that is over needs none.
    if (entry.is_regular_file() && is_plain_path(path) && !path.starts_with("checkpoint")) files_to_send_[path] = 0;
  }
}

void Agent::send_files() {
  if (!collecting_) return;
  while (channel_->unsent() < kUnsentBound && !files_to_send_.empty()) {
    auto& [name, offset] = *files_to_send_.begin();
    const std::string bytes = read_chunk(folder_ / "output" / name, offset);
    channel_->send({{"op", "file"}, {"name", name}, {"offset", offset}, {"hex", hexadecimal(bytes)}});
    offset += bytes.size();
    if (bytes.size() < kChunk) files_to_send_.erase(files_to_send_.begin());
  }
  if (!files_to_send_.empty()) return;
  collecting_ = false;
  channel_->send({{"op", "collected"}});
}

}  // namespace constrictor::cli
