// The directory of a run.
#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "cli/run_command.hpp"
#include "cli/run_record.hpp"
#include "cli/swap.hpp"
#include "cli/usage.hpp"
#include "runtime/recording_options.hpp"

namespace constrictor::cli {

namespace fs = std::filesystem;

fs::path make_new_directory(const fs::path& wanted) {
  if (wanted.has_parent_path()) fs::create_directories(wanted.parent_path());
  fs::path directory = wanted;
  for (int number = 2; !fs::create_directory(directory); ++number)
    directory = fmt::format("{}-{}", wanted.string(), number);
  return directory;
}

void require_space(const fs::path& folder) {
  constexpr std::uintmax_t kLeast = 16 << 20;  // [byte] the checkpoint, the logs and the report of a short run
  constexpr off_t kCheckpoint = 1 << 20;       // [byte] without a checkpoint of this size, the plant cannot start
  std::error_code ignored;
  int error = fs::space(folder, ignored).available < kLeast ? ENOSPC : 0;
  if (error == 0) {
    // Whether a quota leaves room is only found by taking it.
    const fs::path probe = folder / ".space";
    const Descriptor file(::open(probe.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    error = file.open() ? ::posix_fallocate(file.get(), 0, kCheckpoint) : errno;
    fs::remove(probe, ignored);
  }
  if (error == 0 || error == EOPNOTSUPP) return;
  fs::remove(folder, ignored);  // if it was made for this run and is empty
  throw std::runtime_error(
      fmt::format("{}: {}; a run needs {} MiB for its checkpoint, logs and report. Remove files, or name a folder on "
                  "another disk with --report",
                  folder.string(), std::strerror(error), kLeast >> 20));
}

fs::path make_report_dir(const RunOptions& options, const fs::path& scenario) {
  fs::path dir = options.report_dir;
  if (dir.empty()) {
    const std::time_t now = std::time(nullptr);
    const auto name =
        fmt::format("{:%Y%m%d-%H%M%S}_{}_seed{}", fmt::localtime(now), scenario.stem().string(), options.seed);
    dir = make_new_directory(fs::path("runs") / name);
  } else {
    // Everything else in a report can be made again by the same command.
    if (fs::exists(dir / kRecordingFile) && !options.force)
      throw UsageError(
          fmt::format("--report: found {}, which has the recording {} of an earlier run, accepted another "
                      "folder, or --force to replace that run",
                      dir.string(), kRecordingFile));
    fs::create_directories(dir);
  }
  for (const char* old : {"mission.json", "report.json", "figure.png", "hashes.bin", "run.json", "truth.json",
                          kRecordingFile, kOpenChunkFile})
    fs::remove(dir / old);
  remove_checkpoints(dir);
  remove_swaps(dir);
  require_space(dir);
  return fs::absolute(dir);
}

}  // namespace constrictor::cli
