// Which messages are of the present: of the run that is meant, or the first that was heard of, and of its newest epoch. Pure.
#pragma once

#include <cstdint>

namespace constrictor::cli {

class NewestEpoch {
 public:
  enum class Is {
    kOther,    ///< of another run, of none, or of an epoch before the newest
    kPresent,
    kNew,      ///< the first of a newer epoch, or of all: what was known of an earlier one is over
  };
  /// 0: the first run that is heard of.
  explicit NewestEpoch(std::uint64_t run_id = 0) : run_id_(run_id) {}

  Is take(std::uint64_t run_id, std::uint32_t epoch) {
    if (run_id == 0) return Is::kOther;  // of a member that waits for the run to begin
    if (run_id_ == 0) run_id_ = run_id;
    if (run_id != run_id_ || epoch < epoch_) return Is::kOther;
    if (epoch == epoch_) return Is::kPresent;
    epoch_ = epoch;
    return Is::kNew;
  }
  [[nodiscard]] std::uint64_t run_id() const { return run_id_; }  ///< 0: none is meant, and nothing was heard
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }    ///< 0: nothing was heard

 private:
  std::uint64_t run_id_ = 0;
  std::uint32_t epoch_ = 0;
};

}  // namespace constrictor::cli
