// Which messages belong to the newest epoch of one run.
#pragma once

#include <cstdint>

namespace constrictor {

/// Classifies messages by run id and epoch. Pure: no DDS, no clock.
class NewestEpoch {
 public:
  enum class Is {
    kOther,    ///< of another run, of no run, or of an epoch before the newest
    kPresent,  ///< of the newest epoch
    kNew,      ///< the first message of a newer epoch: discard everything known about earlier epochs
  };
  /// If `run_id` is 0, the run is that of the first message.
  explicit NewestEpoch(std::uint64_t run_id = 0) : run_id_(run_id) {}

  Is take(std::uint64_t run_id, std::uint32_t epoch) {
    if (run_id == 0) return Is::kOther;  // from a member that waits for the run to begin
    if (run_id_ == 0) run_id_ = run_id;
    if (run_id != run_id_ || epoch < epoch_) return Is::kOther;
    if (epoch == epoch_) return Is::kPresent;
    epoch_ = epoch;
    return Is::kNew;
  }
  [[nodiscard]] std::uint64_t run_id() const { return run_id_; }  ///< 0: no run was given and no message was taken
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }    ///< 0: no message was taken

 private:
  std::uint64_t run_id_ = 0;
  std::uint32_t epoch_ = 0;
};

}  // namespace constrictor
