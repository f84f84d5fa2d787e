// Whether a camera still sees: notices frames that repeat, and frames that are black.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace constrictor::video {

/// What has happened to a source.
struct News {
  std::string text;      ///< one line, for people
  bool is_good = false;  ///< the source works, or works again; false: something is wrong
};

class FrameCheck {
 public:
  /// Looks at the next frame. Returns news when the camera begins or ceases to be frozen or black.
  std::optional<News> look(const cv::Mat& bgr);

  [[nodiscard]] bool frozen() const { return frozen_; }
  [[nodiscard]] bool black() const { return black_; }

  static constexpr int kFrozenAfter = 4;      ///< equal frames; the noise of a camera makes each frame different
  static constexpr double kBlackBelow = 6.0;  ///< mean of all channels, of 255

 private:
  std::uint64_t fingerprint_ = 0;
  int equal_ = 0;
  bool frozen_ = false;
  bool black_ = false;
};

}  // namespace constrictor::video
