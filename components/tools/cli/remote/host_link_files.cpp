// What the launcher stores of another host: the logs and the files of its processes.
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "cli/remote/host_description.hpp"
#include "cli/remote/host_link.hpp"
#include "constrictor/hex.hpp"

namespace constrictor::cli {
namespace {

/// Writes bytes into a file. Returns the reason why it cannot; empty: it has.
std::string write(const std::filesystem::path& path, const std::string& bytes, std::ios::openmode mode) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | mode);
  file << bytes;
  file.close();
  if (file) return {};
  return fmt::format("cannot write {}: {}", path.string(), ::strerrordesc_np(errno));
}

}  // namespace

void HostLink::take_log(const nlohmann::json& message) {
  const auto found = processes_.find(field<std::string>(message, "name"));
  const auto next = field<std::uintmax_t>(message, "next");
  if (found == processes_.end() || next <= found->second.received) return;
  found->second.received = next;
  const std::string error = write(found->second.log, field<std::string>(message, "text"), std::ios::app);
  if (error.empty() || std::exchange(log_failed_, true)) return;
  print_(fmt::format("host {}: {}; lines of the logs of its processes are lost", name_, error));
}

void HostLink::collect(const std::filesystem::path& folder) {
  collect_into_ = folder;
  collecting_ = true;
  send({{"op", "collect"}});
}

void HostLink::take_file(const nlohmann::json& message) {
  const auto name = field<std::string>(message, "name");
  const auto bytes = bytes_of_hex(field<std::string>(message, "hex"));
  if (!is_plain_path(name) || collect_into_.empty()) throw ProtocolError("file: found the name \"" + name + "\"");
  if (!bytes) throw ProtocolError("file \"" + name + "\": found bytes that are not pairs of hexadecimal digits");
  std::error_code ignored;  // then the file cannot be written either
  std::filesystem::create_directories((collect_into_ / name).parent_path(), ignored);
  const bool first = field<std::uintmax_t>(message, "offset") == 0;
  collected_bytes_ += bytes->size();
  if (first) not_stored_.erase(name);
  else if (not_stored_.contains(name)) return;
  const std::string error = write(collect_into_ / name, *bytes, first ? std::ios::trunc : std::ios::app);
  if (error.empty()) return;
  not_stored_[name] = error;
  std::filesystem::remove(collect_into_ / name, ignored);  // rather no file than a part of one
}

std::string HostLink::missing_files() const {
  std::string text;
  if (!collected_)
    text = up_ ? "the files that its processes wrote are not in the report"
               : "it does not answer: the files that its processes wrote are not in the report";
  else if (!not_stored_.empty())
    text = fmt::format("{} of the files that its processes wrote {} not in the report: {}", not_stored_.size(),
                       not_stored_.size() == 1 ? "is" : "are", not_stored_.begin()->second);
  // Out of reach, the agent keeps what it was told to keep at the start.
  const std::string kept = up_ || preparation_.value("keep", false) ? description_.value("kept", "") : "";
  if (!text.empty() && !kept.empty()) text += fmt::format("; this host keeps them for a week in {}", kept);
  return text;
}

}  // namespace constrictor::cli
