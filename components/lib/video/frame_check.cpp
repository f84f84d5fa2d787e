#include "video/frame_check.hpp"

#include <fmt/format.h>

#include <cstring>

namespace constrictor::video {
namespace {

/// FNV-1a (Fowler, Noll, Vo) over words of eight bytes; the bytes after the last whole word of a row are left out.
std::uint64_t fingerprint(const cv::Mat& image) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const std::size_t length = static_cast<std::size_t>(image.cols) * image.elemSize();
  for (int row = 0; row < image.rows; ++row) {
    const auto* bytes = image.ptr(row);
    for (std::size_t i = 0; i + 8 <= length; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, sizeof word);
      hash = (hash ^ word) * 0x100000001b3;
    }
  }
  return hash;
}

}  // namespace

std::optional<News> FrameCheck::look(const cv::Mat& bgr) {
  const std::uint64_t now = fingerprint(bgr);
  equal_ = now == fingerprint_ ? equal_ + 1 : 1;
  fingerprint_ = now;
  const bool was_frozen = frozen_, was_black = black_;
  frozen_ = equal_ >= kFrozenAfter;
  const cv::Scalar mean = cv::mean(bgr);
  black_ = (mean[0] + mean[1] + mean[2]) / 3.0 < kBlackBelow;
  if (black_ != was_black)
    return News{black_ ? "the image is black: is the lens covered, or the light off?" : "the image is no longer black",
                !black_};
  if (frozen_ != was_frozen)
    return News{
        frozen_ ? fmt::format("the camera is frozen: {} equal frames", equal_) : "the camera is no longer frozen",
        !frozen_};
  return {};
}

}  // namespace constrictor::video
