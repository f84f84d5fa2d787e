#include "perception/smoothing.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace constrictor::perception {
namespace {

// Weights in 1/256, the middle first, as OpenCV rounds the Gaussian curve: the middle weight makes the sum 256.
constexpr std::array<std::uint16_t, 4> kAlong{70, 55, 29, 9};
constexpr std::array<std::int16_t, 2> kAcross{148, 54};
constexpr int kChannels = 3;
constexpr int kPad = 3 * kChannels;  // [byte] half of the width of the window, at both ends of a row
constexpr int kLanes = 16;
constexpr std::uint16_t kHalfRange = 1 << 15;

/// (inner * middle + outer * (above + below)) / 65536, rounded to the nearest, of eight numbers. Half of the range of
/// 16 bits (32768) has been subtracted from the numbers, because the instruction for sums of products is signed.
cv::v_int16x8 across(const std::int16_t* above, const std::int16_t* middle, const std::int16_t* below) {
  // 512 * 16448 = 32768 * 256 (the sum of the weights) + 32768 (for the rounding).
  const auto pair = [](int first, int second) {
    return cv::v_reinterpret_as_s16(cv::v_setall_s32(first | second << 16));
  };
  cv::v_int16x8 low, high, low_below, high_below;
  cv::v_zip(cv::v_load(above), cv::v_load(middle), low, high);
  cv::v_zip(cv::v_load(below), cv::v_setall_s16(16448), low_below, high_below);
  const cv::v_int16x8 weights = pair(kAcross[1], kAcross[0]), weights_below = pair(kAcross[1], 512);
  return cv::v_pack((cv::v_dotprod(low, weights) + cv::v_dotprod(low_below, weights_below)) >> 16,
                    (cv::v_dotprod(high, weights) + cv::v_dotprod(high_below, weights_below)) >> 16);
}

}  // namespace

void Smoother::smooth_along(const std::uint8_t* row, int bytes, std::int16_t* out) {
  std::uint8_t* const middle = padded_.data() + kPad;
  std::memcpy(middle, row, static_cast<std::size_t>(bytes));
  // The image is mirrored at the centres of its first and last pixel.
  for (int pixel = 1; pixel <= kPad / kChannels; ++pixel) {
    std::memcpy(middle - kChannels * pixel, row + kChannels * pixel, kChannels);
    std::memcpy(middle + bytes + kChannels * (pixel - 1), row + bytes - kChannels * (pixel + 1), kChannels);
  }
  for (int i = 0; i < bytes; i += kLanes) {
    cv::v_uint16x8 low, high, low_sum, high_sum;
    const auto load = [&](int offset) { cv::v_expand(cv::v_load(middle + i + offset), low, high); };
    load(0);
    low_sum = cv::v_add_wrap(cv::v_mul_wrap(low, cv::v_setall_u16(kAlong[0])), cv::v_setall_u16(kHalfRange));
    high_sum = cv::v_add_wrap(cv::v_mul_wrap(high, cv::v_setall_u16(kAlong[0])), cv::v_setall_u16(kHalfRange));
    for (int k = 1; k < 4; ++k) {
      const cv::v_uint16x8 weight = cv::v_setall_u16(kAlong[static_cast<std::size_t>(k)]);
      load(-kChannels * k);
      const cv::v_uint16x8 low_left = low, high_left = high;
      load(kChannels * k);
      low_sum = cv::v_add_wrap(low_sum, cv::v_mul_wrap(cv::v_add_wrap(low_left, low), weight));
      high_sum = cv::v_add_wrap(high_sum, cv::v_mul_wrap(cv::v_add_wrap(high_left, high), weight));
    }
    cv::v_store(out + i, cv::v_reinterpret_as_s16(low_sum));
    cv::v_store(out + i + kLanes / 2, cv::v_reinterpret_as_s16(high_sum));
  }
}

void Smoother::smooth(const cv::Mat& rgb, cv::Mat& out) {
  if (rgb.cols <= kPad / kChannels || rgb.rows < 2) {  // too small for the mirrored ends below
    cv::GaussianBlur(rgb, out, {7, 3}, 1.5, 0.7);
    return;
  }
  out.create(rgb.size(), CV_8UC3);
  const int bytes = kChannels * rgb.cols;
  const auto stride = static_cast<std::size_t>((bytes + kLanes - 1) / kLanes * kLanes);
  padded_.resize(stride + 2 * kPad);
  rows_.resize(3 * stride);
  const auto row = [&](int v) { return rows_.data() + static_cast<std::size_t>(v % 3) * stride; };
  smooth_along(rgb.ptr<std::uint8_t>(0), bytes, row(0));
  for (int v = 0; v < rgb.rows; ++v) {
    if (v + 1 < rgb.rows) smooth_along(rgb.ptr<std::uint8_t>(v + 1), bytes, row(v + 1));
    const std::int16_t* above = row(v > 0 ? v - 1 : 1);
    const std::int16_t* below = row(v + 1 < rgb.rows ? v + 1 : v - 1);
    std::uint8_t* to = out.ptr<std::uint8_t>(v);
    int i = 0;
    for (; i + kLanes <= bytes; i += kLanes) {
      constexpr int kHalf = kLanes / 2;
      cv::v_store(to + i, cv::v_pack_u(across(above + i, row(v) + i, below + i),
                                       across(above + i + kHalf, row(v) + i + kHalf, below + i + kHalf)));
    }
    for (; i < bytes; ++i) {
      const int sum = kAcross[0] * (row(v)[i] + kHalfRange) + kAcross[1] * (above[i] + below[i] + 2 * kHalfRange);
      to[i] = static_cast<std::uint8_t>((sum + kHalfRange) >> 16);
    }
  }
}

}  // namespace constrictor::perception
