#include "runtime/run_store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace constrictor {

namespace fs = std::filesystem;

RunStore::RunStore(fs::path folder, bool first, const Log& log)
    : folder_(std::move(folder)), log_(log), file_((fs::create_directories(folder_), folder_ / kFile)) {
  if (first) {
    file_.clear();
    fs::remove(folder_ / kCopy);
  }
  copier_ = std::thread([this] { copy_loop(); });
}

RunStore::~RunStore() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  copier_.join();
}

std::optional<Checkpoint> RunStore::read() {
  if (!file_.of_this_boot())
    throw std::runtime_error(
        (folder_ / kFile).string() +
        ": was written before this computer was started; continue with `constrictor run --resume`");
  auto checkpoint = file_.read();
  if (file_.one_slot_damaged())
    log_.warning("one of the two checkpoints is not complete; the run continues from the other one");
  return checkpoint;
}

void RunStore::write(const Checkpoint& checkpoint) {
  if (failed_) return;
  try {
    file_.write(checkpoint);
  } catch (const std::runtime_error& error) {
    // An old checkpoint must not be taken for the present one.
    failed_ = true;
    file_.clear();
    log_.error("the checkpoint cannot be stored: {}; the run goes on, but if this process dies, the run is lost",
               error.what());
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - last_copy_ < kCopyEvery) return;
  const std::lock_guard lock(mutex_);
  if (copying_) return;
  last_copy_ = now;
  to_copy_ = checkpoint;
  wake_.notify_one();
}

void RunStore::synchronise_files() const {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("checkpoint") || (!entry.is_regular_file() && !entry.is_directory())) continue;
    const int file = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    ::fsync(file);
    ::close(file);
  }
}

void RunStore::copy_loop() {
  bool reported = false;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stop_ || to_copy_; });
    if (stop_) return;
    const Checkpoint checkpoint = *std::exchange(to_copy_, std::nullopt);
    copying_ = true;
    lock.unlock();
    try {
      // The lengths of these files are part of the checkpoint: on the disk they must be at least as long.
      synchronise_files();
      CheckpointFile::store_copy(folder_ / kCopy, checkpoint);
    } catch (const std::exception& error) {
      if (!std::exchange(reported, true))
        log_.error("the checkpoint cannot be copied to the disk: {}; a reboot would lose the run since the last copy",
                   error.what());
    }
    lock.lock();
    copying_ = false;
  }
}

}  // namespace constrictor
