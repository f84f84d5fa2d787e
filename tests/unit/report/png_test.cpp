// Our PNG files against OpenCV's reader.
#include "sim/figure/png.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace constrictor::report {
namespace {

TEST(Png, EncodedImagesAreReadBackByOpenCvWithoutALoss) {
  constexpr int kWidth = 5, kHeight = 7;  // width x 3 is not a multiple of 4
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < kWidth * kHeight; ++i) {  // every pixel has its own colour
    for (const int byte : {7 * i, 255 - i, (31 * i) % 256}) rgb.push_back(static_cast<std::uint8_t>(byte));
  }
  const std::string bytes = encode_png(kWidth, kHeight, rgb.data());
  const cv::Mat read = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  ASSERT_EQ(read.size(), cv::Size(kWidth, kHeight));
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const auto& bgr = read.at<cv::Vec3b>(i / kWidth, i % kWidth);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(bgr[2 - c], rgb[static_cast<std::size_t>(3 * i + c)]) << i;
  }
}

}  // namespace
}  // namespace constrictor::report
