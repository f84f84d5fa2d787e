// When a frame was sent, although only the times of reading are known.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace constrictor::video {

/// Decides for each frame of a live source how old it is, and whether it is fresh. Pure: times are arguments.
///
/// A source without time stamps is read from a buffer of unknown length: after an interruption, the first frames are
/// old ones. A frame for which the reader had to wait was sent just now. So frames are discarded after the source was
/// opened and after a silence, until the reader has to wait for one.
class FrameClock {
 public:
  /// `period_ns`: between two frames, as the source promises. It is only a start: the clock learns the true one.
  explicit FrameClock(std::int64_t period_ns);

  struct Verdict {
    bool fresh = false;
    std::int64_t sent_ns = 0;  ///< when the frame was sent
    std::int64_t missing = 0;  ///< frames that the source has left out before this one
  };
  /// The next frame: reading began and ended at these times.
  Verdict on_frame(std::int64_t began_ns, std::int64_t ended_ns);
  /// The next frame of a source that knows when it received the frame.
  Verdict on_stamped_frame(std::int64_t stamp_ns);

  /// [ns] median time between two of the last frames.
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }

  /// A silence longer than this many periods may have filled buffers.
  static constexpr double kSilence_periods = 2.5;
  /// Discarding ends after this time at the latest: the reader is then as fast as the source, and never waits.
  static constexpr std::int64_t kMostCatchingUp_ns = 2'000'000'000;

 private:
  void learn(std::int64_t interval_ns);

  static constexpr std::size_t kIntervals = 15;
  std::array<std::int64_t, kIntervals> intervals_{};
  std::size_t learned_ = 0;
  std::int64_t period_ns_;
  std::int64_t last_ended_ns_ = -1;  ///< -1: no frame yet
  std::int64_t last_sent_ns_ = -1;
  std::int64_t catching_up_since_ns_ = -1;  ///< -1: it is not
};

}  // namespace constrictor::video
