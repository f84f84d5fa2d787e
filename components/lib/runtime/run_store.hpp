// Stores the checkpoints of the plant's process: in a file that survives the process, and regularly in a copy that
// survives a reboot.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "log/log.hpp"
#include "runtime/checkpoint_file.hpp"

namespace constrictor {

class RunStore {
 public:
  /// Names of the files in the folder of the run.
  static constexpr const char* kFile = "checkpoint.bin";
  static constexpr const char* kCopy = "checkpoint_on_disk.bin";
  /// A reboot or a power failure loses at most this much of the run (wall time), and the time of one copy.
  static constexpr std::chrono::seconds kCopyEvery{10};

  /// `first`: the run begins, so that a checkpoint of an earlier run in this folder is discarded. `log` must outlive
  /// this object. Throws std::runtime_error as CheckpointFile does.
  RunStore(std::filesystem::path folder, bool first, const Log& log);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// The checkpoint from which a restarted process continues; nothing if its predecessor has stored none. Throws
  /// std::runtime_error if there is no complete checkpoint, or if it was stored before a reboot.
  [[nodiscard]] std::optional<Checkpoint> read();
  /// Stores a checkpoint. If that fails because the disk is full, logs it once; the run goes on, but its plant cannot
  /// be restarted any more.
  void write(const Checkpoint& checkpoint);

 private:
  void copy_loop();
  void synchronise_files() const;

  std::filesystem::path folder_;
  const Log& log_;
  CheckpointFile file_;
  bool failed_ = false;
  std::chrono::steady_clock::time_point last_copy_ = std::chrono::steady_clock::now();
  std::mutex mutex_;  ///< of the two below
  std::condition_variable wake_;
  std::optional<Checkpoint> to_copy_;
  bool copying_ = false;
  bool stop_ = false;
  std::thread copier_;
};

}  // namespace constrictor
