#include "cli/log/log_files.hpp"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "log/log.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kOldEnd = ".old";

fs::path old_of(const fs::path& log) { return fs::path(log).replace_extension(std::string(kOldEnd) + ".log"); }

std::uintmax_t size_of(const fs::path& file) {
  std::error_code missing;
  const auto size = fs::file_size(file, missing);
  return missing ? 0 : size;
}

/// Removes the last line if the process was still writing it when it was copied.
void drop_unfinished_line(const fs::path& copy) {
  constexpr std::uintmax_t kLongest = 65'536;  // a line that is longer stays as it is
  const std::uintmax_t size = size_of(copy);
  const std::uintmax_t from = size - std::min(size, kLongest);
  std::ifstream stream(copy, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(from));
  const std::string end{std::istreambuf_iterator<char>(stream), {}};
  const auto newline = end.rfind('\n');
  std::error_code ignored;
  if (newline != std::string::npos) fs::resize_file(copy, from + newline + 1, ignored);
}

/// Copies a log to which a process goes on writing. Returns false if the disk has no room.
bool copy_whole(const fs::path& log, const fs::path& copy) {
  std::error_code error;
  fs::copy_file(log, copy, fs::copy_options::overwrite_existing, error);
  if (error) return false;
  constexpr int kMostRounds = 20;  // a process that writes faster than this copies must not keep it for ever
  for (int round = 0; round < kMostRounds && size_of(log) > size_of(copy); ++round) {
    std::ifstream rest(log, std::ios::binary);
    rest.seekg(static_cast<std::streamoff>(size_of(copy)));
    std::ofstream more(copy, std::ios::binary | std::ios::app);
    more << rest.rdbuf();
    if (!more.flush()) return false;
  }
  drop_unfinished_line(copy);
  return true;
}

}  // namespace

std::string process_of_log(const fs::path& file) {
  const fs::path stem = file.stem();
  return (stem.extension() == kOldEnd ? stem.stem() : stem).string();
}

std::vector<fs::path> log_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && entry.path().extension() == ".log") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const auto key = [](const fs::path& file) {
      return std::pair(process_of_log(file), file.stem().extension() != kOldEnd);
    };
    return key(a) < key(b);
  });
  return files;
}

void remove_log(const fs::path& log) {
  std::error_code ignored;
  fs::remove(log, ignored);
  fs::remove(old_of(log), ignored);
}

bool bound_log(const fs::path& log, std::uintmax_t most) {
  const std::uintmax_t size = size_of(log);
  if (size <= most) return false;
  const fs::path old = old_of(log);
  const std::uintmax_t dropped = size_of(old);
  const fs::path copy = old.string() + ".new";
  std::error_code error;
  const bool kept = copy_whole(log, copy);
  if (kept) fs::rename(copy, old, error);
  else fs::remove(copy, error);
  fs::resize_file(log, 0, error);
  if (error) return true;
  try {
    const Log note("launcher", log);
    if (!kept) note.warning("no room on the disk: {} bytes of older lines of this log were dropped", size);
    else if (dropped > 0)
      note.warning("older lines of this log are in {}; {} bytes of still older lines were dropped",
                   old.filename().string(), dropped);
    else note.info("older lines of this log are in {}", old.filename().string());
  } catch (const std::exception&) {
    // The note is for people; without it the log is as useful as before.
  }
  return true;
}

void bound_logs(const fs::path& folder, std::uintmax_t most) {
  for (const auto& file : log_files(folder)) {
    if (file.stem().extension() != kOldEnd) bound_log(file, most);
  }
}

}  // namespace constrictor::cli
